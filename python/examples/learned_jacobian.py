"""Learns how two cameras see the tip move when the arm bends, and drives the tip to pixels with what it learned.

The learner knows no model: it tries small random changes of the bends, and fits a linear map to the pixels. On the way
to the target, each step corrects the map (Broyden's rule). The last line compares the map with the derivative of the
model.
"""

# %% An arm of two sections, and what two cameras see of its tip.
import numpy as np

import flexura

random = np.random.default_rng(1)
experiment = flexura.Experiment(arm={"kind": "spatial", "section": [{"length": 0.3}] * 2})
arm, cameras = experiment.arm, experiment.cameras


def pixels(bends):
    """Returns the tip's pixels in both pictures, shape (4,)."""
    tip = arm.tip(bends.reshape(2, 2))[:3, 3]
    return np.concatenate([camera.project(tip) for camera in cameras])


# %% The learner tries small changes of the bends, and fits a linear map.
bends = np.array([0.4, 0.1, 0.2, -0.3])
tries = random.normal(0, 0.02, (30, 4))
changes = np.array([pixels(bends + change) for change in tries]) - pixels(bends)
learned = np.linalg.lstsq(tries, changes, rcond=None)[0].T

# %% The map is almost the derivative of the model.
tip = arm.tip(bends.reshape(2, 2))[:3, 3]
by_state = arm.jacobian(bends.reshape(2, 2))[:3, [0, 1, 3, 4]]
true = np.vstack([camera.projection(tip)["by_point"] for camera in cameras]) @ by_state
print(f"difference from the derivative: {np.linalg.norm(learned - true) / np.linalg.norm(true):.3f}")

# %% The map drives the tip to its pixels, and is corrected on the way.
target = pixels(np.array([0.7, -0.3, 0.5, 0.2]))
errors = []
for step in range(30):
    error = target - pixels(bends)
    errors.append(np.abs(error).max())
    if errors[-1] < 0.01:
        break
    change = np.linalg.lstsq(learned, error, rcond=1e-3)[0]
    change *= min(1, 0.3 / np.abs(change).max())
    before, bends = pixels(bends), bends + change
    learned += np.outer(pixels(bends) - before - learned @ change, change) / (change @ change)
else:
    raise SystemExit("the tip did not reach its pixels")
print(f"the tip is at its pixels after {step} steps")

# %% The error after each step.
try:
    import matplotlib.pyplot as plt
except ImportError:
    print("no plot: matplotlib is not installed")
else:
    figure, axes = plt.subplots()
    axes.semilogy(errors, "o-")
    axes.set(xlabel="steps", ylabel="largest error, px", title="A learned map drives the tip to its pixels")
    figure.savefig("learned_jacobian.png")
