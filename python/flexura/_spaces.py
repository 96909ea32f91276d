"""Gymnasium's classes where it is installed, otherwise classes with the part of their interface that is used here."""

import numpy as np

try:
    import gymnasium
    from gymnasium.spaces import Box

    Env = gymnasium.Env
    VectorEnv = gymnasium.vector.VectorEnv
    HAS_GYMNASIUM = True
except ImportError:
    HAS_GYMNASIUM = False

    class Box:
        """The arrays of one shape and type between two bounds."""

        def __init__(self, low, high, shape, dtype):
            self.shape, self.dtype = tuple(shape), np.dtype(dtype)
            self.low = np.full(self.shape, low, self.dtype)
            self.high = np.full(self.shape, high, self.dtype)
            self._random = np.random.default_rng()

        def seed(self, seed=None):
            """Restarts the random numbers of sample()."""
            self._random = np.random.default_rng(seed)

        def sample(self):
            """Returns a random array: uniform between finite bounds, otherwise normally distributed."""
            if self.dtype.kind in "iu":
                return self._random.integers(self.low, self.high, endpoint=True, dtype=self.dtype)
            if np.isfinite(self.low).all() and np.isfinite(self.high).all():
                return self._random.uniform(self.low, self.high).astype(self.dtype)
            return self._random.standard_normal(self.shape).astype(self.dtype)

        def contains(self, x):
            """Returns whether x is an array of this space."""
            return (
                isinstance(x, np.ndarray)
                and x.shape == self.shape
                and np.can_cast(x.dtype, self.dtype)
                and bool(np.all(x >= self.low) and np.all(x <= self.high))
            )

        __contains__ = contains

        def __eq__(self, other):
            return (
                isinstance(other, Box)
                and self.dtype == other.dtype
                and np.array_equal(self.low, other.low)
                and np.array_equal(self.high, other.high)
            )

        def __repr__(self):
            return f"Box({self.low.min(initial=0)}, {self.high.max(initial=0)}, {self.shape}, {self.dtype})"

    class Env:
        """The part of gymnasium.Env that environments inherit."""

        render_mode = None
        spec = None
        _np_random = None

        @property
        def unwrapped(self):
            return self

        @property
        def np_random(self):
            """Random numbers of the environment."""
            if self._np_random is None:
                self._np_random = np.random.default_rng()
            return self._np_random

        def reset(self, *, seed=None, options=None):
            if seed is not None:
                self._np_random = np.random.default_rng(seed)

        def close(self):
            pass

        def __enter__(self):
            return self

        def __exit__(self, *_):
            self.close()

    VectorEnv = Env


def batched(box, count):
    """Returns the space of `count` arrays of a Box."""
    shape = (count, *box.shape)
    if box.dtype.kind in "iu":
        return Box(box.low.min(), box.high.max(), shape, box.dtype)
    return Box(box.low.flat[0], box.high.flat[0], shape, box.dtype)
