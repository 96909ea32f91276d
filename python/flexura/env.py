"""Environments for learning: an arm reaches for a tip position or a shape.

The environments follow Gymnasium's interface, and inherit its classes if it is installed. An episode starts with the
arm at rest, and a random target that the arm can reach.

Actions are numbers from -1 to 1. For an elastic arm (sections with the key `material`, and tendons, its own or those of
a drive) they are tensions, from 0 to `max_tension`, and the arm moves by its dynamics. Otherwise they are the rates of
the bends, up to `max_rate` (bend_x and bend_y of each section).

The error is the distance of the tip, or the root mean square distance of five points of the backbone, from the
target, as part of the arm's length. The reward of an action is minus the error, plus 1 if the target is reached (the
error is at most `tolerance`), which terminates the episode. After `max_steps` actions, or if the motion cannot be
computed, the episode is truncated. info["error"] has the error, info["is_success"] whether the target was reached.

Observations are
- "state": float32 (n,): the strain modes, as angles (rad) and strains, and their rates, or the bends; the observed
  points of the backbone; the points of the target. Points are positions relative to the base, m.
- "pictures": uint8 (4, height, width): the arm as seen by the first two cameras of an Experiment, and the target shape
  as seen by these cameras.
"""

import numpy as np

from . import _spaces
from ._flexura import Arm, Experiment, ReachBatch

__all__ = ["ReachEnv", "VectorReachEnv", "tendon_arm"]


def tendon_arm(sections=3):
    """Returns an elastic arm that hangs down, with `sections` sections of 0.2 m and three tendons for each section.

    The arm has six unknowns for each section: three modes for each of its two bends.
    """
    material = {
        "youngs_modulus": 5e6,
        "density": 1000,
        "radius": [0.006, 0.006],
        "damping_time": 0.02,
        "modes": {"shear": 0, "stretch": 0, "bend": 3, "twist": 0},
        "nodes": 5,
    }
    section = {"length": 0.2, "radius": [0.012, 0.012], "max_bend_deg": 150, "material": material}
    tendons = [
        {"section": i + 1, "radius": 0.01, "angle_deg": 120 * k + 40 * i} for i in range(sections) for k in range(3)
    ]
    return Arm(
        kind="spatial",
        model="dynamic",
        gravity=[0, -9.81, 0],
        base={"rotation": [0, 0, 0.7071067811865476, -0.7071067811865476]},
        section=[section] * sections,
        tendon=tendons,
    )


def _batch(
    model,
    count,
    threads,
    observation,
    *,
    target="tip",
    elastic=None,
    time_step=0.05,
    substeps=5,
    max_steps=200,
    tolerance=0.02,
    max_tension=5.0,
    max_rate=1.0,
):
    """Returns the ReachBatch of an environment. The defaults are those of ReachEnv and VectorReachEnv."""
    if observation not in ("state", "pictures"):
        raise ValueError(f'observation: {observation!r}: expected "state" or "pictures"')
    experiment = model if isinstance(model, Experiment) else None
    arm = model.true_arm if experiment else model
    if elastic is None:
        elastic = arm.tendons > 0
    pictures = observation == "pictures"
    return ReachBatch(
        arm,
        experiment,
        count,
        threads,
        target=target,
        elastic=elastic,
        time_step=time_step,
        substeps=substeps,
        max_steps=max_steps,
        tolerance=tolerance,
        max_tension=max_tension,
        max_rate=max_rate,
        pictures=pictures,
    )


def _observation_space(batch, observation):
    if observation == "state":
        return _spaces.Box(-np.inf, np.inf, (batch.observations,), np.float32)
    width, height = batch.picture_size
    return _spaces.Box(0, 255, (4, height, width), np.uint8)


def _action_space(batch):
    return _spaces.Box(-1.0, 1.0, (batch.actions,), np.float32)


class _Reach:
    """What both environments share."""

    def _make(self, model, count, threads, observation, settings):
        self._batch = _batch(model, count, threads, observation, **settings)
        self._observation = observation
        self._is_seeded = False

    def _start(self, seed, chosen=None):
        """Starts episodes. Without a seed, the random streams continue."""
        if seed is not None or not self._is_seeded:
            self._batch.reset(int(self.np_random.integers(2**63)), chosen)
            self._is_seeded = True
        else:
            self._batch.reset(None, chosen)

    def _observe(self):
        return self._batch.observe() if self._observation == "state" else self._batch.photograph()


class ReachEnv(_Reach, _spaces.Env):
    """One arm that reaches for a target; the module describes actions, observations and rewards.

    model: an Arm, or an Experiment, which is needed for pictures. observation: "state" or "pictures". render_mode: None
    or "rgb_array". Further settings and their defaults: target="tip" or "shape"; elastic=None: whether actions are
    tensions (default: whether the arm has materials and tendons, its own or those of a drive); time_step=0.05: time of
    an action, s; substeps=5: steps of the dynamics in this time; max_steps=200; tolerance=0.02; max_tension=5.0, N;
    max_rate=1.0, rad/s.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 20}

    def __init__(self, model, *, observation="state", render_mode=None, **settings):
        if render_mode not in (None, "rgb_array"):
            raise ValueError(f'render_mode: {render_mode!r}: expected None or "rgb_array"')
        if render_mode and not isinstance(model, Experiment):
            raise ValueError("render_mode: expected an Experiment, whose first camera takes the pictures")
        self._make(model, 1, 1, observation, settings)
        self.observation_space = _observation_space(self._batch, observation)
        self.action_space = _action_space(self._batch)
        self.render_mode = render_mode
        self._photographer = model.photographer() if render_mode else None

    def reset(self, *, seed=None, options=None):
        """Starts an episode. Returns its first observation and info."""
        super().reset(seed=seed)
        self._start(seed)
        self._has_ended = False
        return self._observe()[0], {}

    def step(self, action):
        """Applies an action. Returns observation, reward, terminated, truncated, info."""
        if getattr(self, "_has_ended", True):
            raise RuntimeError("the episode has ended: expected a call of reset()")
        action = np.asarray(action, dtype=np.float64)
        if action.shape != self.action_space.shape:
            raise ValueError(f"action: shape {action.shape}: expected {self.action_space.shape}")
        rewards, terminated, truncated, errors = self._batch.step(action[None])
        self._has_ended = bool(terminated[0] or truncated[0])
        info = {"error": float(errors[0]), "is_success": bool(terminated[0])}
        return self._observe()[0], float(rewards[0]), bool(terminated[0]), bool(truncated[0]), info

    def render(self):
        """Returns a picture of the arm by the first camera, uint8 (height, width, 3); None without a render_mode."""
        if self._photographer is None:
            return None
        picture = self._photographer.take(0, self._batch.backbone(0))
        return np.repeat(picture[..., None], 3, axis=2) if picture.ndim == 2 else picture


class VectorReachEnv(_Reach, _spaces.VectorEnv):
    """`num_envs` arms that reach for targets, computed on `threads` threads; arguments as for ReachEnv.

    Results do not depend on the number of threads. The action after the end of an arm's episode starts its next
    episode: it is ignored, its reward is 0, and its observation is the first of the new episode (Gymnasium's mode
    NEXT_STEP).
    """

    metadata = {"render_modes": [], "autoreset_mode": "NextStep"}
    if _spaces.HAS_GYMNASIUM and hasattr(_spaces.gymnasium.vector, "AutoresetMode"):
        metadata["autoreset_mode"] = _spaces.gymnasium.vector.AutoresetMode.NEXT_STEP

    def __init__(self, model, num_envs, *, threads=1, observation="state", **settings):
        self._make(model, num_envs, threads, observation, settings)
        self.num_envs = num_envs
        self.single_observation_space = _observation_space(self._batch, observation)
        self.single_action_space = _action_space(self._batch)
        self.observation_space = _spaces.batched(self.single_observation_space, num_envs)
        self.action_space = _spaces.batched(self.single_action_space, num_envs)

    def reset(self, *, seed=None, options=None):
        """Starts an episode of each arm. Returns the observations (num_envs, ...) and infos.

        seed: an integer; each arm has a random stream of its own.
        """
        if seed is not None:
            self._np_random = np.random.default_rng(seed)
        self._start(seed)
        return self._observe(), {}

    @property
    def np_random(self):
        """Random numbers, from which the seeds of the arms are drawn."""
        if self._np_random is None:
            self._np_random = np.random.default_rng()
        return self._np_random

    def step(self, actions):
        """Applies actions (num_envs, n). Returns observations, rewards, terminated, truncated, infos."""
        rewards, terminated, truncated, errors = self._batch.step(actions)
        return self._observe(), rewards, terminated, truncated, {"error": errors, "is_success": terminated}
