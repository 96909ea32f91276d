import json
import pathlib
import subprocess

import numpy as np
import pytest

import flexura

WAVE = """
title = "A wave"
record.report = false
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
name = "bow"
duration = 0.4
to.bends_deg = [[60, 0], [0, 90]]
[[task]]
kind = "move"
name = "back"
duration = 0.3
to.bends_deg = [[0, 0], [0, 0]]
"""


@pytest.fixture
def wave():
    return flexura.Experiment.parse(WAVE, "wave.toml")


def test_a_run_calls_back_and_leaves_its_results(wave, tmp_path):
    states, events, messages, fractions = [], [], [], []
    result = wave.run(
        tmp_path / "wave",
        on_state=lambda time, state: states.append((time, state)),
        on_event=lambda *event: events.append(event),
        on_message=lambda *message: messages.append(message),
        on_progress=lambda fraction, what: fractions.append(fraction),
    )
    assert result.outcome == "done" and result.reasons == []
    assert [task["task"] for task in result.tasks] == ["bow", "back"] and all(task["reached"] for task in result.tasks)
    assert result.folder == tmp_path / "wave"
    assert result.summary == json.loads((result.folder / "summary.json").read_text())
    assert fractions == sorted(fractions) and 0 <= fractions[0] <= fractions[-1] <= 1
    log = flexura.Log(result.folder)
    times, logged = log.states()
    np.testing.assert_allclose(times, [time for time, _ in states], atol=1e-12)
    np.testing.assert_array_equal(logged, [state for _, state in states])
    np.testing.assert_allclose(logged[20], wave.arm.state(bends_deg=[[60, 0], [0, 90]]), atol=1e-9)
    assert log.topics["/arm/state"] == len(states) == len(log.messages("/arm/state")) == 36
    assert len(events) == log.topics["/events"]
    assert log.messages("/events")[0][1]["message"] == events[0][3]
    with pytest.raises(KeyError, match="/nothing"):
        log.messages("/nothing")


def test_python_and_the_program_write_equal_bytes(wave, program, tmp_path):
    (tmp_path / "wave.toml").write_text(WAVE)
    subprocess.run([program, "run", "wave.toml", "--out", "by_program"], cwd=tmp_path, check=True, capture_output=True)
    flexura.Experiment.load(tmp_path / "wave.toml").run(tmp_path / "by_python", on_state=lambda *_: None)
    files = sorted(file.name for file in (tmp_path / "by_program").iterdir() if file.is_file())
    assert {"log.mcap", "summary.json", "experiment.toml"} <= set(files)
    for name in files:
        if name != "timing.json":
            assert (tmp_path / "by_python" / name).read_bytes() == (tmp_path / "by_program" / name).read_bytes(), name


def test_results_are_never_overwritten(wave, tmp_path):
    folders = [wave.run(tmp_path / "wave").folder.name for _ in range(2)]
    assert folders == ["wave", "wave-2"]


def test_a_callback_can_end_a_run(wave, tmp_path):
    assert wave.run(tmp_path / "short", on_progress=lambda *_: False).outcome == "cancelled"
    assert wave.run(tmp_path / "short", on_progress=lambda *_: np.False_).outcome == "cancelled"


def test_an_exception_of_a_callback_is_raised(wave, tmp_path):
    seen = []

    def stop(time, state):
        seen.append(time)
        if time > 0.1:
            raise KeyError("enough")

    with pytest.raises(KeyError, match="enough"):
        wave.run(tmp_path / "broken", on_state=stop)
    assert seen[-1] == pytest.approx(0.12)


def test_errors_have_file_line_and_column(tmp_path):
    file = tmp_path / "bad.toml"
    file.write_text('[arm]\nkind = "spatial"\n[[arm.section]]\nlength = -1\nlenght = 2\n')
    with pytest.raises(flexura.InputError) as caught:
        flexura.Experiment.load(file)
    error = caught.value
    assert (error.file, error.line, error.column) == (str(file), 5, 1) or error.line == 4
    places = {(line, column) for _, line, column, _ in error.problems}
    assert places == {(4, 10), (5, 1)}
    assert str(error).splitlines()[0].startswith(f"{file}:{error.line}:{error.column}: ")
    with pytest.raises(flexura.InputError, match="nothing.toml"):
        flexura.Experiment.load(tmp_path / "nothing.toml")


def test_changes_of_a_file(tmp_path):
    (tmp_path / "wave.toml").write_text(WAVE)
    changed = flexura.Experiment.load(
        tmp_path / "wave.toml",
        sets={"arm.section.0.length": 0.5, "task.0.to.bends_deg": np.zeros((2, 2)), "title": 'a "title"'},
        seed=7,
    )
    assert changed.arm.lengths[0] == 0.5 and changed.seed == 7 and changed.title == 'a "title"'
    assert changed.table["task"][0]["to"]["bends"] == [[0, 0], [0, 0]]
    with pytest.raises(flexura.InputError, match="arm.section.9.length"):
        flexura.Experiment.load(tmp_path / "wave.toml", sets={"arm.section.9.length": 1.0})


def test_an_experiment_is_made_from_keys_and_from_its_own_text(wave):
    made = flexura.Experiment(
        title="A wave",
        record={"report": False},
        arm={"kind": "spatial", "section": [{"length": 0.3, "max_bend_deg": 120}, {"length": 0.25, "max_bend_deg": 120}]},
        task=[
            {"kind": "move", "name": "bow", "duration": 0.4, "to": {"bends_deg": [[60, 0], [0, 90]]}},
            {"kind": "move", "name": "back", "duration": 0.3, "to": {"bends_deg": [[0, 0], [0, 0]]}},
        ],
    )
    assert made.table == wave.table
    assert flexura.Experiment.parse(wave.to_toml()).table == wave.table
    with pytest.raises(flexura.InputError, match=r"arm.section\[0\].length = 0"):
        flexura.Experiment(arm={"section": [{"length": 0}]})


def test_every_example_is_read(examples):
    files = sorted(examples.glob("*/experiment.toml"))
    assert len(files) > 15
    for file in files:
        experiment = flexura.Experiment.load(file)
        assert experiment.arm.sections == len(experiment.table["arm"]["section"])
        assert len(experiment.cameras) >= 1


def test_a_file_that_is_no_log_is_refused(tmp_path):
    file = tmp_path / "log.mcap"
    file.write_bytes(b"nothing")
    with pytest.raises(RuntimeError, match="log.mcap"):
        flexura.Log(file)
    with pytest.raises(OSError):
        flexura.Log(pathlib.Path("/nothing/there"))
