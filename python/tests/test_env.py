"""Checks what Gymnasium's check_env checks, without Gymnasium; and with it, where it is installed."""

import inspect

import arms
import numpy as np
import pytest

import flexura
from flexura import _flexura
from flexura.env import ReachEnv, VectorReachEnv, tendon_arm

SMALL_CAMERAS = [
    {
        "name": name,
        "mount": {"position": position, "look_at": [0, 0.4, 0]},
        "lens": {"fx": 60, "fy": 60},
        "sensor": {"width": 64, "height": 48},
    }
    for name, position in [("front", [0, 0.4, 1.6]), ("side", [-1.6, 0.4, 0])]
]


def scene():
    section = {"length": 0.3, "radius": [0.04, 0.04], "max_bend_deg": 90}
    return flexura.Experiment(arm={"kind": "spatial", "section": [section] * 2}, camera=SMALL_CAMERAS)


def environments():
    return {
        "tip": lambda: ReachEnv(tendon_arm(), max_steps=30),
        "shape": lambda: ReachEnv(tendon_arm(2), target="shape", max_steps=30),
        "bends": lambda: ReachEnv(arms.two_sections(), max_steps=30),
        "planar": lambda: ReachEnv(flexura.Arm(kind="planar", section=[{"length": 1}] * 3), max_steps=30),
        "pictures": lambda: ReachEnv(
            scene(), target="shape", observation="pictures", max_steps=10, render_mode="rgb_array"
        ),
    }


@pytest.fixture(params=sorted(environments()))
def make(request):
    return environments()[request.param]


def rollout(env, seed, count):
    """Returns observations, rewards and ends of `count` random actions."""
    env.action_space.seed(seed)
    observation, info = env.reset(seed=seed)
    found = [(observation, 0.0, False, False)]
    for _ in range(count):
        observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
        found.append((observation, reward, terminated, truncated))
        if terminated or truncated:
            found.append((env.reset()[0], 0.0, False, False))
    return found


def test_spaces_and_types_are_as_promised(make):
    env = make()
    observation, info = env.reset(seed=3)
    assert isinstance(info, dict)
    assert observation in env.observation_space
    assert np.all(env.action_space.low == -1) and np.all(env.action_space.high == 1)
    assert env.action_space.dtype == np.float32
    for _ in range(12):
        action = env.action_space.sample()
        assert action in env.action_space
        observation, reward, terminated, truncated, info = env.step(action)
        assert observation in env.observation_space
        assert isinstance(reward, float) and np.isfinite(reward)
        assert isinstance(terminated, bool) and isinstance(truncated, bool) and isinstance(info, dict)
        if terminated or truncated:
            env.reset()


def test_the_interface_is_that_of_gymnasium(make):
    env = make()
    assert env.unwrapped is env and env.spec is None
    # Names and defaults of the arguments of reset.
    reset = inspect.signature(env.reset).parameters
    assert {name: of.default for name, of in reset.items()} == {"seed": None, "options": None}
    assert not hasattr(env, "seed")
    assert isinstance(env.metadata["render_modes"], list) and env.metadata["render_fps"] > 0
    assert env.render_mode is None or env.render_mode in env.metadata["render_modes"]
    answer = env.reset(seed=1, options={})
    assert isinstance(answer, tuple) and len(answer) == 2
    answer = env.step(env.action_space.sample())
    assert isinstance(answer, tuple) and len(answer) == 5
    env.close()
    env.close()
    with make() as other:
        other.reset(seed=0)


def test_spaces_are_sound(make):
    env = make()
    for space in (env.observation_space, env.action_space):
        assert space.low.shape == space.high.shape == space.shape and space.low.dtype == space.high.dtype == space.dtype
        assert (space.low < space.high).all() and space.sample() in space
        assert space == type(space)(space.low.min(), space.high.max(), space.shape, space.dtype)
    assert (env.action_space.low == -env.action_space.high).all()


def test_a_step_is_a_function_of_seed_and_action(make):
    env = make()
    env.action_space.seed(123)
    action = env.action_space.sample()
    answers, states = [], []
    for _ in range(2):
        env.reset(seed=123)
        answers.append(env.step(action))
        states.append(env.np_random.bit_generator.state)
    assert states[0] == states[1]
    np.testing.assert_array_equal(answers[0][0], answers[1][0])
    assert answers[0][1:] == answers[1][1:]
    env.reset(seed=456)
    assert env.np_random.bit_generator.state != states[0]


def test_observations_belong_to_the_caller(make):
    env = make()
    first = env.reset(seed=2)[0]
    kept = first.copy()
    second = env.step(env.action_space.sample())[0]
    np.testing.assert_array_equal(first, kept)
    second[...] = 0
    assert env.reset(seed=2)[0].any() and not second.any()


def test_pictures_of_an_environment_have_the_type_of_its_mode(make):
    env = make()
    env.reset(seed=1)
    picture = env.render()
    if env.render_mode is None:
        assert picture is None
    else:
        assert isinstance(picture, np.ndarray) and picture.dtype == np.uint8 and picture.ndim == 3 and picture.shape[2] == 3


def test_an_arm_with_a_drive_has_its_tendons():
    section = {"length": 0.3, "radius": [0.01, 0.01], "material": {"youngs_modulus": 1e6, "density": 1000, "damping_time": 0.02}}
    drive = {"radius": 0.008, "tendon": [{"section": i, "angle_deg": 120 * k} for i in (1, 2) for k in range(3)]}
    driven = flexura.Experiment(arm={"kind": "spatial", "section": [section] * 2}, drive=drive)
    assert driven.arm.tendons == driven.true_arm.tendons == 6
    assert ReachEnv(driven).action_space.shape == (6,)
    assert arms.two_sections().tendons == 0 and tendon_arm().tendons == 9
    assert ReachEnv(driven, elastic=False).action_space.shape == (4,)


def test_a_vector_has_the_interface_of_gymnasium():
    vector = VectorReachEnv(arms.two_sections(), 3)
    assert vector.num_envs == 3 and vector.observation_space.shape == (3, *vector.single_observation_space.shape)
    observations, infos = vector.reset(seed=1, options={})
    assert observations in vector.observation_space and isinstance(infos, dict)
    observations, rewards, terminated, truncated, infos = vector.step(vector.action_space.sample())
    assert rewards.shape == terminated.shape == truncated.shape == (3,)
    assert rewards.dtype == np.float64 and terminated.dtype == truncated.dtype == bool
    vector.close()


def test_equal_seeds_give_equal_episodes(make):
    first, second, other = (rollout(make(), seed, 25) for seed in (5, 5, 6))
    assert len(first) == len(second)
    for one, two in zip(first, second):
        np.testing.assert_array_equal(one[0], two[0])
        assert one[1:] == two[1:]
    assert any((one[0] != two[0]).any() for one, two in zip(first, other))


def test_a_reset_with_a_seed_restarts_the_random_numbers():
    env = ReachEnv(tendon_arm())
    first = env.reset(seed=1)[0]
    state = env.np_random.bit_generator.state
    np.testing.assert_array_equal(env.reset(seed=1)[0], first)
    assert env.np_random.bit_generator.state == state
    assert (env.reset()[0] != first).any()
    assert (env.reset(seed=2)[0] != first).any()


def test_episodes_are_truncated_and_must_be_reset():
    env = ReachEnv(arms.two_sections(), max_steps=4, tolerance=0)
    env.reset(seed=0)
    ends = [env.step(np.zeros(4))[2:4] for _ in range(4)]
    assert ends == [(False, False)] * 3 + [(False, True)]
    with pytest.raises(RuntimeError, match=r"expected a call of reset\(\)"):
        env.step(np.zeros(4))
    with pytest.raises(RuntimeError, match="reset"):
        ReachEnv(arms.two_sections()).step(np.zeros(4))


def test_an_episode_ends_at_its_target():
    # Inverse kinematics on the observed target, and the rates that lead there.
    arm = arms.two_sections()
    env = ReachEnv(arm, tolerance=0.01)
    observation, _ = env.reset(seed=4)
    goal = arm.inverse(observation[-3:] + arm.base[:3, 3]).state[:, :2]
    for _ in range(200):
        action = np.clip((goal.ravel() - observation[:4]) / 0.05, -1, 1)
        observation, reward, terminated, truncated, info = env.step(action)
        if terminated:
            break
        assert reward == -info["error"]
    assert terminated and info["is_success"] and info["error"] <= 0.01
    assert reward == pytest.approx(1 - info["error"])
    assert np.linalg.norm(observation[-6:-3] - observation[-3:]) == pytest.approx(info["error"] * 0.55, abs=1e-6)


def test_tensions_move_the_arm_as_its_dynamics(random):
    arm = tendon_arm()
    env = ReachEnv(arm, time_step=0.05, substeps=5, max_tension=4)
    env.reset(seed=0)
    dynamics = flexura.Dynamics(arm, tolerance=1e-4)
    state = dynamics.rest(flexura.Statics(arm).solve(tensions=np.zeros(9)))
    for _ in range(10):
        action = random.uniform(-1, 1, 9)
        observation = env.step(action)[0]
        for _ in range(5):
            dynamics.step(state, 4 * (action + 1) / 2, h=0.01)
        np.testing.assert_allclose(observation[-6:-3], dynamics.tip(state)[:3, 3], atol=2e-5)


def test_wrong_arguments_are_refused():
    with pytest.raises(ValueError, match="target: expected"):
        ReachEnv(tendon_arm(), target="tail")
    with pytest.raises(ValueError, match="observation: 'smell'"):
        ReachEnv(tendon_arm(), observation="smell")
    with pytest.raises(ValueError, match="expected an Experiment"):
        ReachEnv(tendon_arm(), observation="pictures")
    with pytest.raises(ValueError, match="render_mode"):
        ReachEnv(tendon_arm(), render_mode="human")
    with pytest.raises(ValueError, match="count: 0: expected at least 1"):
        VectorReachEnv(tendon_arm(), 0)
    env = ReachEnv(tendon_arm())
    env.reset(seed=0)
    with pytest.raises(ValueError, match=r"action: shape \(3,\): expected \(9,\)"):
        env.step(np.zeros(3))
    with pytest.raises(ValueError, match="not NaN"):
        env.step(np.full(9, np.nan))


def test_pictures_show_the_arm_and_its_target():
    env = ReachEnv(scene(), target="shape", observation="pictures", render_mode="rgb_array")
    pictures, _ = env.reset(seed=1)
    assert pictures.shape == (4, 48, 64) and (pictures[:2] != pictures[2:]).any()
    photographer = scene().photographer()
    straight = scene().arm.state()
    for camera in range(2):
        np.testing.assert_array_equal(pictures[camera], photographer.take(camera, straight))
    picture = env.render()
    assert picture.shape == (48, 64, 3) and picture.dtype == np.uint8
    np.testing.assert_array_equal(picture[..., 0], pictures[0])


@pytest.mark.parametrize("elastic", [True, False])
def test_vectors_do_not_depend_on_threads_and_start_anew(elastic, random):
    model = tendon_arm() if elastic else arms.two_sections()
    vectors = [VectorReachEnv(model, 6, threads=threads, max_steps=5, tolerance=0.05) for threads in (1, 2, 5)]
    firsts = [vector.reset(seed=9)[0] for vector in vectors]
    for first in firsts[1:]:
        np.testing.assert_array_equal(first, firsts[0])
    assert len(np.unique(firsts[0][:, -3:], axis=0)) == 6
    had_ended = np.zeros(6, bool)
    targets = firsts[0][:, -3:]
    for step in range(14):
        actions = random.uniform(-1, 1, vectors[0].action_space.shape)
        answers = [vector.step(actions) for vector in vectors]
        for answer in answers[1:]:
            for one, two in zip(answer[:4], answers[0][:4]):
                np.testing.assert_array_equal(one, two)
        observations, rewards, terminated, truncated, infos = answers[0]
        assert observations.shape == vectors[0].observation_space.shape and observations.dtype == np.float32
        # An ended episode is followed by the first observation of another, with another target.
        assert not rewards[had_ended].any() and not (terminated | truncated)[had_ended].any()
        np.testing.assert_array_equal((observations[:, -3:] != targets).any(axis=1), had_ended)
        targets, had_ended = observations[:, -3:], terminated | truncated
    np.testing.assert_array_equal(infos["is_success"], terminated)


def test_an_arm_of_a_vector_moves_as_alone(random):
    settings = dict(
        target="tip", elastic=True, time_step=0.05, substeps=5, max_steps=9, tolerance=0.02, max_tension=5.0, max_rate=1.0,
        pictures=False,
    )
    one, many = (_flexura.ReachBatch(tendon_arm(), None, count, 1, **settings) for count in (1, 4))
    for batch in (one, many):
        batch.reset(seed=3)
    for _ in range(15):
        actions = random.uniform(-1, 1, (4, 9))
        np.testing.assert_array_equal(one.step(actions[:1]), np.array(many.step(actions))[:, :1])
        np.testing.assert_array_equal(one.observe(), many.observe()[:1])


def test_gymnasium_accepts_the_environments(make):
    checker = pytest.importorskip("gymnasium.utils.env_checker", reason="needs gymnasium")
    checker.check_env(make(), skip_render_check=False)
