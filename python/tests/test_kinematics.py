import arms
import numpy as np
import pytest

import flexura


def test_the_tip_of_an_arc_has_its_closed_form(random):
    arm = flexura.Arm(kind="spatial", section=[{"length": 0.4}])
    for bend in random.uniform(-3, 3, (50, 2)):
        t = np.linalg.norm(bend)
        in_base = 0.4 * np.append(bend * (1 - np.cos(t)) / t**2, np.sin(t) / t)
        # The base's x is the world's X, its y is -Z and its z is Y.
        expected = np.array([in_base[0], in_base[2], -in_base[1]])
        np.testing.assert_allclose(arm.tip([bend])[:3, 3], expected, atol=1e-14)


def test_the_tip_is_that_of_the_library():
    # The program of docs/library.md prints this position.
    tip = arms.two_sections().tip([[1.0, 0.0], [0.0, 0.0]])
    np.testing.assert_allclose(tip[:3, 3], [0.348277, 0.387517, 0], atol=5e-7)
    np.testing.assert_array_equal(tip[3], [0, 0, 0, 1])


@pytest.mark.parametrize("make", [arms.two_sections, arms.stretching, arms.uneven])
@pytest.mark.parametrize("name", ["tip", "frames", "jacobian"])
def test_many_states_equal_single_ones(make, name, random):
    arm = make()
    states = arms.random_states(random, arm, 24).reshape(4, 6, arm.sections, 3)
    function = getattr(arm, name)
    every = function(states)
    assert every.shape[:2] == (4, 6)
    for i in range(4):
        for k in range(6):
            np.testing.assert_array_equal(every[i, k], function(states[i, k]))
    np.testing.assert_array_equal(function(states, threads=3), every)


def test_results_are_written_into_out(random):
    arm = arms.two_sections()
    states = arms.random_states(random, arm, 5)
    out = np.empty((7, 4, 4))
    part = out[1:6]
    assert arm.tip(states, out=part) is part
    np.testing.assert_array_equal(out[1:6], arm.tip(states))


@pytest.mark.parametrize(
    "out",
    [np.empty((5, 4, 3)), np.empty((5, 4, 4), np.float32), np.empty((5, 4, 8))[:, :, ::2], np.empty((4, 4)), [0.0] * 16],
)
def test_an_out_that_does_not_fit_is_refused(out):
    with pytest.raises(ValueError, match=r"out: expected a writable C-contiguous array of float64 with shape \(5, 4, 4\)"):
        arms.two_sections().tip(np.zeros((5, 2, 3)), out=out)


def test_an_out_that_is_read_only_is_refused():
    out = np.empty((4, 4))
    out.flags.writeable = False
    with pytest.raises(ValueError, match="writable"):
        arms.two_sections().tip(np.zeros((2, 2)), out=out)


def test_stretches_may_be_omitted_and_other_types_are_converted():
    arm = arms.two_sections()
    full = arm.tip([[0.5, 0.1, 1], [0.2, -0.4, 1]])
    np.testing.assert_array_equal(arm.tip([[0.5, 0.1], [0.2, -0.4]]), full)
    turned = np.asfortranarray([[0.5, 0.1], [0.2, -0.4]])
    np.testing.assert_array_equal(arm.tip(turned), full)


@pytest.mark.parametrize("states", [np.zeros(2), np.zeros((3, 2)), np.zeros((2, 4)), np.zeros((5, 3, 3))])
def test_states_of_another_shape_are_refused(states):
    with pytest.raises(ValueError, match=r"states: shape .*: expected \(\.\.\., 2, 2\)"):
        arms.two_sections().tip(states)


@pytest.mark.parametrize("make", [arms.two_sections, arms.stretching, arms.uneven])
def test_jacobians_are_the_derivatives(make, random):
    arm = make()
    h = 1e-6
    for state in arms.random_states(random, arm, 10):
        jacobian = arm.jacobian(state)
        rotation = arm.tip(state)[:3, :3]
        for column in range(3 * arm.sections):
            step = np.zeros(3 * arm.sections)
            step[column] = h
            after, before = (arm.tip(state + sign * step.reshape(-1, 3)) for sign in (1, -1))
            np.testing.assert_allclose(jacobian[:3, column], (after - before)[:3, 3] / (2 * h), atol=1e-8)
            spin = (after - before)[:3, :3] @ rotation.T / (2 * h)
            np.testing.assert_allclose(jacobian[3:, column], [spin[2, 1], spin[0, 2], spin[1, 0]], atol=1e-8)


def test_frames_and_points_agree_with_the_tip(random):
    arm = arms.stretching()
    for state in arms.random_states(random, arm, 5):
        frames = arm.frames(state)
        np.testing.assert_array_equal(frames[0], arm.base)
        np.testing.assert_allclose(frames[-1], arm.tip(state), atol=1e-15)
        points = arm.points(state, [0, 0.5, 1])
        np.testing.assert_allclose(points[[0, 2]], frames[[0, -1], :3, 3], atol=1e-14)
        backbone = arm.backbone(state)
        np.testing.assert_allclose(backbone.points([0, 0.5, 1]), points, atol=1e-15)
        assert backbone.length == pytest.approx(arm.lengths @ state[:, 2])


def test_a_point_outside_the_arm_is_refused():
    with pytest.raises(ValueError, match="fractions: 1.5: expected a number from 0 to 1"):
        arms.two_sections().points(np.zeros((2, 2)), [1.5])


def test_inverse_kinematics_finds_what_forward_kinematics_gave(random):
    arm = arms.stretching()
    states = arms.random_states(random, arm, 8, 1.0)
    targets = arm.tip(states)
    for target in targets:
        result = arm.inverse(target[:3, 3], rotation=target[:3, :3])
        assert result.converged and result.reason == "converged"
        np.testing.assert_allclose(arm.tip(result.state), target, atol=1e-8)
    found, converged, errors = arm.inverse_batch(targets[:, :3, 3], threads=2)
    assert converged.all() and errors.max() < 1e-8
    for i, target in enumerate(targets):
        np.testing.assert_array_equal(found[i], arm.inverse(target[:3, 3]).state)


def test_a_target_out_of_reach_has_a_reason():
    result = arms.two_sections().inverse([0, 2, 0])
    assert not result.converged and result.is_proven and result.reason == "not_reachable"
    assert result.position_error == pytest.approx(2 - 0.55)


def test_inverse_kinematics_follows_a_curve(random):
    arm = arms.two_sections()
    state = arms.random_states(random, arm, 1, 1.0)[0]
    result = arm.inverse_curve(arm.points(state, np.linspace(0, 1, 41)))
    assert result.converged
    np.testing.assert_allclose(result.state[:, :2], state[:, :2], atol=0.02)


def test_states_come_from_the_keys_of_files():
    arm = arms.two_sections()
    np.testing.assert_allclose(arm.state(bends_deg=[[60, 0], [0, 90]]), [[np.pi / 3, 0, 1], [0, np.pi / 2, 1]])
    np.testing.assert_array_equal(arm.state(), [[0, 0, 1], [0, 0, 1]])
    planar = flexura.Arm(kind="planar", section=[{"length": 1}])
    np.testing.assert_allclose(planar.state(archings=[0.3]), [[-0.6, 0, 1]])
    with pytest.raises(flexura.InputError, match="bends: 1 given: expected 2"):
        arm.state(bends=[[1, 0]])


def test_wrong_keys_of_an_arm_are_all_reported():
    with pytest.raises(flexura.InputError) as caught:
        flexura.Arm(kind="spatial", section=[{"length": -1}, {"lenght": 1, "length": 1}])
    whats = [what for _, _, _, what in caught.value.problems]
    assert any("section[0].length = -1: expected a number" in what for what in whats)
    assert any('section[1].lenght: unknown key; did you mean "length"?' in what for what in whats)
    assert isinstance(caught.value, ValueError)
    with pytest.raises(TypeError, match="expected a number, str, list or dict"):
        flexura.Arm(kind={1, 2})


def test_an_arm_is_made_from_its_own_table():
    arm = arms.uneven()
    assert flexura.Arm(**arm.table).table == arm.table
    assert arm.table["section"][0]["bend_profile"] == [1, 2, 1]
