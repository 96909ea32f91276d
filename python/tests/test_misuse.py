"""Wrong arguments that once ended the interpreter, or gave wrong numbers silently."""

import threading

import numpy as np
import pytest

import flexura
from flexura.env import ReachEnv, tendon_arm


def arm_with(tendons):
    """Returns the arm of tendon_arm() with only the first tendons."""
    table = dict(tendon_arm().table)
    table["tendon"] = list(table["tendon"])[:tendons]
    return flexura.Arm(**table)


def test_a_state_of_an_arm_with_other_tendons_is_refused():
    many, few = tendon_arm(), arm_with(3)
    mine, other = flexura.Dynamics(many), flexura.Dynamics(few)
    assert mine.size == other.size
    with pytest.raises(ValueError, match="expected those of this arm"):
        mine.step(other.rest(), [0.0] * 9)
    batch = flexura.DynamicsBatch(many, 2)
    with pytest.raises(ValueError, match="expected those of this arm"):
        batch.set_state(0, other.rest())


def test_threads_may_share_a_state():
    arm = tendon_arm()
    solvers = [flexura.Dynamics(arm) for _ in range(2)]
    state = solvers[0].rest()
    is_over = threading.Event()
    torn = []

    def read():
        while not is_over.is_set():
            copy = state.copy()
            if len(copy.q) != len(copy.momentum) or not np.isfinite(copy.q).all():
                torn.append(copy)

    readers = [threading.Thread(target=read) for _ in range(2)]
    steppers = [
        threading.Thread(target=lambda solver=solver: [solver.step(state, [1.0] * 9) for _ in range(60)])
        for solver in solvers
    ]
    for thread in readers + steppers:
        thread.start()
    for thread in steppers:
        thread.join()
    is_over.set()
    for thread in readers:
        thread.join()
    assert not torn
    assert state.time > 0


def board_views(pixels_of):
    """Returns views of a board of 9 x 6 points, in front of a camera, through pixels_of(x, y, z)."""
    points = np.array([(0.025 * column, 0.025 * row, 0) for row in range(6) for column in range(9)])
    random = np.random.default_rng(1)
    views = []
    for _ in range(10):
        axis = random.normal(size=3)
        axis *= random.uniform(0.3, 0.6) / np.linalg.norm(axis)
        K = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
        R = np.linalg.inv(np.eye(3) - K / 2) @ (np.eye(3) + K / 2)
        middle = np.array([0.1, 0.0625, 0])
        aside = random.uniform(-0.1, 0.1, 2)
        p = (points - middle) @ R.T + [*aside, 0.25]
        views.append(np.stack(pixels_of(*p.T), axis=1))
    return views


def fisheye(x, y, z):
    radius = np.hypot(x, y)
    angle = np.arctan2(radius, z)
    height = 220 * angle * (1 + 0.02 * angle**2)
    return 319.5 + height * x / radius, 239.5 + height * y / radius


def test_views_may_be_arrays():
    views = board_views(fisheye)
    listed = flexura.fit_intrinsics([[view] for view in views], [(640, 480)], model="fisheye")
    assert listed["found"], listed["reason"]
    camera = listed["cameras"][0]
    assert camera["model"] == "fisheye"
    assert camera["fx"] == pytest.approx(220, abs=1e-3)
    assert camera["distortion"] == pytest.approx([0.02, 0, 0, 0], abs=1e-3)
    assert camera["covariance"].shape == (8, 8)
    array = np.array(views)[:, None]
    assert flexura.fit_intrinsics(array, [(640, 480)], model="fisheye")["cameras"][0]["fx"] == camera["fx"]
    assert not flexura.fit_intrinsics(array, [(640, 480)], distortion=0)["found"]
    with pytest.raises(ValueError, match="model"):
        flexura.fit_intrinsics(array, [(640, 480)], model="pinhole")


def test_estimates_need_cameras_and_one_finite_state():
    arm = flexura.Arm(kind="spatial", section=[{"length": 0.5}])
    picture = np.full((48, 64), 200, np.uint8)
    with pytest.raises(ValueError, match="not None"):
        arm.estimate([picture, picture], [None, None])
    camera = flexura.Experiment(arm=arm.table).cameras[0]
    for near, message in ((np.zeros((5, 1, 2)), "one state"), (np.full((1, 2), np.nan), "finite")):
        with pytest.raises(ValueError, match=message):
            arm.estimate([picture], [camera], near=near)


def test_a_level_is_finite():
    with pytest.raises(ValueError, match="finite"):
        flexura.measure(np.full((48, 64), 200, np.uint8), threshold="fixed", level=float("nan"))


def test_a_mask_chooses_arms():
    batch = flexura.DynamicsBatch(tendon_arm(), 3)
    batch.step(tensions=np.full((3, 9), 1.0) * np.arange(9), steps=3)
    moved = batch.q().copy()
    batch.reset(np.array([True, False, True]))
    assert not batch.q()[0].any() and not batch.q()[2].any()
    assert (batch.q()[1] == moved[1]).all()
    with pytest.raises(ValueError, match="bool"):
        batch.reset(np.array([True, False]))


def test_an_environment_needs_reachable_targets():
    with pytest.raises(ValueError, match="no target can be reached"):
        ReachEnv(tendon_arm(), max_tension=1e9)
    with pytest.raises(ValueError, match="finite"):
        ReachEnv(tendon_arm(), max_tension=float("inf"))


def test_results_do_not_overwrite_the_states():
    arm = flexura.Arm(kind="spatial", section=[{"length": 0.3}, {"length": 0.25}])
    memory = np.zeros(5 * 16)
    with pytest.raises(ValueError, match="shares memory"):
        arm.tip(memory[: 5 * 6].reshape(5, 2, 3), memory.reshape(5, 4, 4))


def test_wrong_types_are_type_errors():
    with pytest.raises(TypeError):
        flexura.Arm(kind="spatial", section=[{"length": 2**70}])
