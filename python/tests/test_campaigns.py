import json
import subprocess
import threading

import numpy as np
import pytest

import flexura

BOW = """
[arm]
kind = "spatial"
[[arm.section]]
length = 0.30
max_bend_deg = 120
[[arm.section]]
length = 0.25
max_bend_deg = 120
[[task]]
kind = "move"
duration = 0.1
to.bends_deg = [[60, 0], [0, 90]]
"""
VARIED = """
experiment = "bow.toml"
sampling = "sobol"
samples = 32
[[parameter]]
kind = "uniform"
path = "arm.section.0.length"
name = "length"
low = 0.2
high = 0.4
[[parameter]]
kind = "normal"
path = "task.0.to.bends_deg.1.1"
name = "bend_deg"
mean = 110
sigma = 15
[[parameter]]
kind = "choice"
path = "task.0.law"
name = "law"
choices = ["minimum_jerk", "linear"]
[[measure]]
key = "tip.position.1"
name = "height"
[[measure]]
key = "outcomes.0.kind"
name = "kind"
"""


@pytest.fixture
def file(tmp_path):
    (tmp_path / "bow.toml").write_text(BOW)
    (tmp_path / "varied.toml").write_text(VARIED)
    return tmp_path / "varied.toml"


def test_a_campaign_fills_a_table_that_its_experiments_explain(file, tmp_path):
    campaign = flexura.Campaign.load(file)
    assert campaign.runs == 64
    assert campaign.parameters == ["length", "bend_deg", "law"] and campaign.measures == ["height", "kind"]
    fractions = []
    end = campaign.run(tmp_path / "new" / "varied.db", workers=2, on_progress=lambda part, _: fractions.append(part))
    assert end.complete and not end.cancelled and end.runs == 64 and end.runs_before == 0
    assert end.file == tmp_path / "new" / "varied.db" and end.reason == "all 64 runs are done" == end.results.reason
    assert fractions and fractions == sorted(fractions) and fractions[-1] <= 1
    table = end.results.table()
    assert list(table) == ["id", "seed", "status", "error", "seconds", "length", "bend_deg", "law", "height", "kind"]
    assert table["id"].dtype == np.int64 and table["height"].dtype == np.float64 and table["law"].dtype == object
    np.testing.assert_array_equal(table["id"], np.arange(64))
    is_done = table["status"] == "done"
    # Bends beyond 120 deg are unsafe.
    np.testing.assert_array_equal(is_done, table["bend_deg"] <= 120)
    assert 0 < is_done.sum() < 64
    for i in (0, 5, 63):
        values = campaign.values(i)
        assert values == {name: table[name][i] for name in campaign.parameters}
        assert campaign.seed(i) == table["seed"][i]
        experiment = end.results.experiment(i)
        assert experiment.table == campaign.experiment(i).table and experiment.seed == table["seed"][i]
        assert experiment.arm.lengths[0] == values["length"]
        if is_done[i]:
            reached = experiment.arm.state(bends_deg=[[60, 0], [0, values["bend_deg"]]])
            assert table["height"][i] == pytest.approx(experiment.arm.tip(reached)[1, 3], abs=1e-9)


def test_python_and_the_program_fill_equal_tables(file, tmp_path, program):
    command = [program, "campaign", file.name, "--out", "by_program.db", "--set", "samples=4"]
    subprocess.run(command, cwd=tmp_path, check=True, capture_output=True)
    flexura.Campaign.load(file, {"samples": 4}).run(tmp_path / "by_python.db", workers=1)
    tables = [flexura.CampaignResults(tmp_path / f"by_{who}.db").table() for who in ("program", "python")]
    for name in tables[0]:
        if name != "seconds":
            np.testing.assert_array_equal(tables[0][name], tables[1][name], err_msg=name)
    # Either goes on where the other has stopped.
    flexura.Campaign.load(file, {"samples": 4}).run(
        tmp_path / "shared.db", workers=1, on_progress=lambda *_: False
    )
    done = subprocess.run(
        [program, "campaign", file.name, "--out", "shared.db", "--set", "samples=4", "--json"],
        cwd=tmp_path, check=True, capture_output=True, text=True,
    )
    assert json.loads(done.stdout)["runs"] == 8
    shared = flexura.CampaignResults(tmp_path / "shared.db").table()
    np.testing.assert_array_equal(shared["height"], tables[0]["height"])


def test_a_row_is_replayed_with_all_files(file, tmp_path):
    results = flexura.Campaign.load(file, {"samples": 4}).run(tmp_path / "a.db").results
    row = int(np.flatnonzero(results.table()["status"] == "done")[0])
    replay = results.experiment(row, {"record.report": False}).run(tmp_path / "replay")
    assert replay.outcome == "done" and (replay.folder / "log.mcap").exists()
    assert replay.summary["tip"]["position"][1] == results.table()["height"][row]
    with pytest.raises(IndexError, match="run 8: the campaign has 8 runs: expected 0 to 7"):
        results.experiment(8)
    with pytest.raises(IndexError):
        results.experiment(-1)


def test_a_callback_can_stop_a_campaign_that_later_goes_on(file, tmp_path):
    campaign = flexura.Campaign.load(file, {"samples": 2048})
    end = campaign.run(tmp_path / "part.db", workers=1, on_progress=lambda *_: False)
    assert end.cancelled and not end.complete and 0 < end.runs < 4096 and end.reason == "stopped"
    assert end.results.reason == "" and len(end.results.table()["id"]) == end.runs

    def fail(*_):
        raise KeyError("enough")

    with pytest.raises(KeyError, match="enough"):
        campaign.run(tmp_path / "part.db", on_progress=fail)
    later = campaign.run(tmp_path / "part.db", workers=1, on_progress=lambda *_: False)
    assert later.runs_before >= end.runs and later.runs > later.runs_before


def test_campaigns_are_made_from_experiments_and_from_files(file, tmp_path):
    keys = {
        "samples": 8,
        "parameter": [{"kind": "uniform", "path": "arm.section.0.length", "name": "length", "low": 0.2, "high": 0.4}],
        "measure": [{"key": "tip.position.1", "name": "height"}],
    }
    tables = []
    for experiment in (tmp_path / "bow.toml", str(tmp_path / "bow.toml"), flexura.Experiment.load(tmp_path / "bow.toml")):
        campaign = flexura.Campaign(experiment, **keys)
        tables.append(campaign.run(tmp_path / f"{len(tables)}.db").results.table())
        assert (tables[-1]["status"] == "done").all()
    for table in tables[1:]:
        np.testing.assert_array_equal(table["height"], tables[0]["height"])
    assert len(np.unique(tables[0]["height"])) == 8
    changed = flexura.Campaign(tmp_path / "bow.toml", set=["arm.section.1.length=0.1"], **keys)
    assert changed.experiment(0).arm.lengths[1] == 0.1


def test_a_measure_depends_on_its_parameter_alone(file, tmp_path):
    campaign = flexura.Campaign(
        tmp_path / "bow.toml",
        samples=200,
        parameter=[{"kind": "uniform", "path": "arm.section.0.length", "name": "length", "low": 0.2, "high": 0.4}],
        measure=[{"key": "tip.position.1", "name": "height"}],
    )
    results = campaign.run(tmp_path / "s.db").results
    found = results.sensitivity("height", "length")
    # The height is linear in the length: ten groups explain 1 - 1/100 of the variance.
    assert found["rank_correlation"] == pytest.approx(1) and found["share"] == pytest.approx(0.99, abs=0.01)
    with pytest.raises(KeyError, match="no column"):
        results.sensitivity("height", "width")


def test_results_become_pages_and_tables(file, tmp_path):
    results = flexura.Campaign.load(file, {"samples": 2}).run(tmp_path / "p.db").results
    assert results.report() == tmp_path / "p.html" and "<html" in (tmp_path / "p.html").read_text()
    assert results.to_csv() == tmp_path / "p.csv"
    assert (tmp_path / "p.csv").read_text().splitlines()[0].startswith("id,seed,status,error,seconds,length")
    with pytest.raises(flexura.InputError, match="p.csv: exists already"):
        results.to_csv()
    assert results.to_csv(tmp_path / "q.csv").read_bytes() == (tmp_path / "p.csv").read_bytes()


def test_errors_have_their_place(file, tmp_path):
    file.write_text(VARIED.replace("low = 0.2", "lwo = 0.2"))
    with pytest.raises(flexura.InputError) as caught:
        flexura.Campaign.load(file)
    assert (caught.value.file, caught.value.line) == (str(file), 9)
    file.write_text(VARIED.replace("arm.section.0.length", "arm.section.9.length"))
    with pytest.raises(flexura.InputError, match="the index 9 is outside") as caught:
        flexura.Campaign.load(file)
    assert (caught.value.file, caught.value.line) == (str(file), 7)
    with pytest.raises(flexura.InputError, match="sampels"):
        flexura.Campaign(tmp_path / "bow.toml", sampels=3)
    with pytest.raises(flexura.InputError, match="no such file"):
        flexura.CampaignResults(tmp_path / "none.db")
    (tmp_path / "bad.db").write_bytes(b"nothing")
    with pytest.raises(flexura.InputError, match="bad.db"):
        flexura.CampaignResults(tmp_path / "bad.db")
    file.write_text(VARIED)
    with pytest.raises(ValueError, match="workers: 0: expected 1 to 4096"):
        flexura.Campaign.load(file).run(tmp_path / "w.db", workers=0)
    flexura.Campaign.load(file, {"samples": 1}).run(tmp_path / "w.db")
    with pytest.raises(flexura.InputError, match="another campaign"):
        flexura.Campaign.load(file, {"samples": 2}).run(tmp_path / "w.db")


def test_threads_may_read_while_a_campaign_runs(file, tmp_path):
    campaign = flexura.Campaign.load(file, {"samples": 64})
    counts, errors = [], []

    def read():
        try:
            counts.append(len(flexura.CampaignResults(tmp_path / "t.db").table()["id"]))
        except BaseException as error:
            errors.append(error)

    readers = []

    def start_a_reader(*_):
        readers.append(threading.Thread(target=read))
        readers[-1].start()

    end = campaign.run(tmp_path / "t.db", on_progress=start_a_reader)
    for reader in readers:
        reader.join()
    assert errors == [] and len(counts) == len(readers) > 0 and max(counts) <= end.runs == 128
