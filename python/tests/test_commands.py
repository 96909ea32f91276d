"""What the program can do, Python can."""

import json
import re
import subprocess

import numpy as np
import pytest
from conftest import SOURCE

import flexura
from flexura import _program
from flexura.env import tendon_arm

SHORT = {"record.report": False, "record.scene": False, "task.4.duration": 0.1}


@pytest.fixture(scope="module")
def swing(tmp_path_factory):
    """An experiment with an elastic arm, and the folder of its run."""
    file = SOURCE / "examples" / "15_step_response" / "experiment.toml"
    experiment = flexura.Experiment.load(file, SHORT)
    return experiment, experiment.run(tmp_path_factory.mktemp("swing") / "run").folder


def check_material(found):
    expected = {
        ("youngs_modulus", 1): 3.0e5, ("youngs_modulus", 2): 2.1e5, ("damping_time", 1): 0.024, ("damping_time", 2): 0.016,
    }
    values = {(value["parameter"], value["section"]): value for value in found["values"]}
    assert values.keys() == expected.keys()
    for key, true in expected.items():
        value = values[key]
        assert value["observable"] and value["physical"]
        assert abs(value["value"] - true) < 5 * value["sigma"] and value["sigma"] < 0.1 * true, key


def test_a_log_tells_the_material(swing):
    experiment, folder = swing
    parts = []
    found = experiment.identify(folder, noise=2e-4, on_progress=lambda part, _: parts.append(part))
    check_material(found)
    assert found["notes"] == [] and 0.3 < found["misfit"] < 3
    assert found["residual_rms"] < found["nominal_residual_rms"]
    assert parts and parts == sorted(parts) and parts[-1] <= 1 + 1e-9


def test_the_program_identifies_the_same(swing, program):
    experiment, folder = swing
    file = folder / "experiment.toml"
    done = subprocess.run(
        [program, "identify", file, folder, "--noise-mm", "0.2", "--json"], check=True, capture_output=True, text=True
    )
    *values, rest = [json.loads(line) for line in done.stdout.splitlines()]
    found = flexura.Experiment.load(file).identify(folder, noise=2e-4)
    assert found.pop("values") == values and found.pop("notes") == []
    assert found == rest


def test_measured_positions_tell_the_material(random):
    nominal = tendon_arm(2).table
    true = tendon_arm(2).table
    for section in true["section"]:
        section["material"] |= {"youngs_modulus": 6e6, "damping_time": 0.03}
    arm = flexura.Arm(**true)
    dynamics = flexura.Dynamics(arm)
    state = dynamics.rest(flexura.Statics(arm).solve(tensions=[2, 0, 0, 0, 1, 0]))
    s = np.linspace(0.05, 0.4, 8)
    times, positions = [], []
    for _ in range(200):
        dynamics.step(state, np.zeros(6), h=0.005)
        times.append(state.time)
        positions.append(dynamics.backbone(state).points(s / 0.4))
    times, positions = np.array(times), np.array(positions)
    motion = {
        "time": times, "tensions": np.zeros((200, 6)), "s": s, "positions": positions + random.normal(0, 1e-4, positions.shape),
    }
    found = flexura.Experiment(arm=nominal).identify(motion, noise=1e-4, alike=True)
    for value, expected in zip(found["values"], [6e6, 0.03]):
        assert value["observable"] and abs(value["value"] - expected) < 5 * value["sigma"] < 0.2 * expected
    part = flexura.Experiment(arm=nominal).identify(motion, noise=1e-4, start=0.1, end=0.6, alike=True)
    assert part["samples"] == ((times >= 0.1) & (times <= 0.6)).sum() < found["samples"] == 200


def test_motions_that_do_not_fit_are_refused(swing):
    experiment, folder = swing
    good = {"time": np.arange(30) * 0.01, "tensions": np.zeros((30, 6)), "s": [0.5], "positions": np.zeros((30, 1, 3))}
    for change, message in [
        ({"tensions": np.zeros((30, 5))}, r"tensions.*\(N, 6\)"),
        ({"tensions": np.zeros((29, 6))}, "first of size 30"),
        ({"positions": np.zeros((30, 2, 3))}, r"positions.*\(N, 1, 3\)"),
        ({"s": [0.6]}, "0.6: expected an arc length above 0 and at most 0.5 m"),
        ({"s": [0.0]}, "expected an arc length above 0"),
    ]:
        with pytest.raises(ValueError, match=message):
            experiment.identify(good | change)
    with pytest.raises(ValueError, match='expected the key "s"'):
        experiment.identify({"time": [0.0], "tensions": np.zeros((1, 6)), "positions": np.zeros((1, 1, 3))})
    with pytest.raises(ValueError, match="start: expected a time before end"):
        experiment.identify(folder, start=2, end=1)
    with pytest.raises(ValueError, match="noise: -1: expected a number above 0"):
        experiment.identify(folder, noise=-1)
    with pytest.raises(flexura.InputError, match="no such file"):
        experiment.identify(folder / "nothing")
    with pytest.raises(flexura.InputError, match="material"):
        flexura.Experiment(arm={"section": [{"length": 1}]}).identify(folder)


def test_a_check_equals_that_of_the_program(program, examples):
    file = examples / "01_paper_arm" / "experiment.toml"
    for sets, is_safe in [({}, True), ({"arm.section.1.max_bend_deg": 3}, False)]:
        texts = [f"--set={path}={value}" for path, value in sets.items()]
        done = subprocess.run([program, "check", file, "--json", *texts], capture_output=True, text=True)
        report = flexura.Experiment.load(file, sets).check()
        assert report == json.loads(done.stdout)
        assert report["safe"] is is_safe and bool(report["violations"]) is not is_safe


def test_logs_are_exported(swing, tmp_path):
    _, folder = swing
    tables = flexura.export(folder)
    assert tables == folder / "csv" and (tables / "states.csv").exists() and (tables / "tensions.csv").exists()
    assert flexura.export(folder, "csv").name == "csv-2"
    with pytest.raises(flexura.InputError):
        flexura.export(folder, "png")  # The run recorded no pictures.
    with pytest.raises(ValueError, match='to: "pdf": expected "csv", "mp4" or "png"'):
        flexura.export(folder, "pdf")
    with pytest.raises(flexura.InputError):
        flexura.export(tmp_path)


def test_schemas_are_those_of_the_program(program):
    for of in ("experiment", "campaign"):
        done = subprocess.run([program, "schema", "--of", of], check=True, capture_output=True, text=True)
        assert flexura.schema(of) == json.loads(done.stdout)
    with pytest.raises(ValueError, match='of: "arm": expected'):
        flexura.schema("arm")


def test_tensions_bring_a_tip_to_a_target(random):
    arm = tendon_arm(2)
    statics = flexura.Statics(arm)
    for _ in range(3):
        pulls = random.uniform(0, 2, 6)
        target = statics.tip(statics.solve(tensions=pulls))
        found = statics.inverse(target[:3, 3], max_tension=5)
        assert found.reached and found.reason and found.position_error < 1e-8
        again = statics.solve(tensions=found.tensions)
        np.testing.assert_allclose(statics.tip(again)[:3, 3], target[:3, 3], atol=1e-7)
        # The tensions known have no smaller sum of squares.
        assert np.square(found.tensions).sum() <= np.square(pulls).sum() * (1 + 1e-6)
        turned = statics.inverse(target[:3, 3], direction=target[:3, 2], max_tension=[5.0] * 6)
        if turned.reached:
            direction = statics.tip(turned.equilibrium)[:3, 2]
            np.testing.assert_allclose(direction, target[:3, 2], atol=1e-6)
    far = statics.inverse([5, 0, 0], max_tension=5)
    assert not far.reached and far.position_error > 4
    with pytest.raises(ValueError, match=r"tensions: 3 given: expected 6 values"):
        statics.inverse([0, 0, 0], max_tension=[1, 2, 3])


def test_the_program_is_called_for_other_commands(program, tmp_path, examples):
    new = flexura.program("new", "servo", "--out", tmp_path / "servo.toml")
    assert new.status == 0 and (tmp_path / "servo.toml").exists() and "servo.toml" in new.output
    with pytest.raises(flexura.InputError) as caught:
        flexura.program("check", examples / "01_paper_arm" / "experiment.toml", "--set", "arm.kind=3")
    assert caught.value.problems and caught.value.file
    (tmp_path / "bad.toml").write_text("[arm]\nlength = 3\n")
    with pytest.raises(flexura.InputError) as caught:
        flexura.program("check", tmp_path / "bad.toml")
    assert (caught.value.file, caught.value.line, caught.value.column) == (str(tmp_path / "bad.toml"), 2, 1)
    arm = examples / "01_paper_arm" / "experiment.toml"
    answers = flexura.program("fk", arm, lines=[{"archings": [0.0] * 8}, {"archings": [0.1] * 8}]).documents
    assert [set(answer) >= {"tip", "bases"} for answer in answers] == [True, True]
    missed = flexura.program("check", arm, "--set", "arm.section.1.max_bend_deg=3", "--json")
    assert missed.status == 1 and missed.documents[0]["safe"] is False


def test_a_missing_program_is_reported(monkeypatch, tmp_path):
    monkeypatch.delenv("FLEXURA_PROGRAM", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr(_program, "__file__", str(tmp_path / "a" / "b" / "_program.py"))
    monkeypatch.setattr(_program.sysconfig, "get_path", lambda _: str(tmp_path))
    with pytest.raises(FileNotFoundError, match="FLEXURA_PROGRAM"):
        flexura.program("new")


def test_every_command_has_a_way_from_python(program):
    """docs/python.md has a table of all commands."""
    said = subprocess.run([program, "--help"], check=True, capture_output=True, text=True).stdout
    commands = set(re.findall(r"^  ([a-z]+)  ", said, re.MULTILINE))
    assert {"run", "campaign", "identify", "man"} <= commands
    text = (SOURCE / "docs" / "python.md").read_text()
    table = text[text.index("## Commands"):].split("\n## ")[0]
    assert commands <= set(re.findall(r"`([a-z]+)", table))
