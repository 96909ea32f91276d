from typing import Any, Literal, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _spaces
from ._flexura import Arm, Experiment

__all__: list[str]

Observation = Union[NDArray[np.float32], NDArray[np.uint8]]

def tendon_arm(sections: int = 3) -> Arm: ...

class ReachEnv(_spaces.Env):
    metadata: dict[str, Any]
    observation_space: _spaces.Box
    action_space: _spaces.Box
    render_mode: Optional[str]
    def __init__(
        self,
        model: Union[Arm, Experiment],
        *,
        observation: Literal["state", "pictures"] = "state",
        render_mode: Optional[Literal["rgb_array"]] = None,
        target: Literal["tip", "shape"] = "tip",
        elastic: Optional[bool] = None,
        time_step: float = 0.05,
        substeps: int = 5,
        max_steps: int = 200,
        tolerance: float = 0.02,
        max_tension: float = 5.0,
        max_rate: float = 1.0,
    ) -> None: ...
    def reset(
        self, *, seed: Optional[int] = None, options: Optional[dict[str, Any]] = None
    ) -> tuple[Observation, dict[str, Any]]: ...
    def step(self, action: ArrayLike) -> tuple[Observation, float, bool, bool, dict[str, Any]]: ...
    def render(self) -> Optional[NDArray[np.uint8]]: ...

class VectorReachEnv(_spaces.VectorEnv):
    metadata: dict[str, Any]
    num_envs: int
    observation_space: _spaces.Box
    action_space: _spaces.Box
    single_observation_space: _spaces.Box
    single_action_space: _spaces.Box
    def __init__(
        self,
        model: Union[Arm, Experiment],
        num_envs: int,
        *,
        threads: int = 1,
        observation: Literal["state", "pictures"] = "state",
        target: Literal["tip", "shape"] = "tip",
        elastic: Optional[bool] = None,
        time_step: float = 0.05,
        substeps: int = 5,
        max_steps: int = 200,
        tolerance: float = 0.02,
        max_tension: float = 5.0,
        max_rate: float = 1.0,
    ) -> None: ...
    def reset(
        self, *, seed: Optional[int] = None, options: Optional[dict[str, Any]] = None
    ) -> tuple[Observation, dict[str, Any]]: ...
    def step(
        self, actions: ArrayLike
    ) -> tuple[Observation, NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]: ...
