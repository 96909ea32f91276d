"""Two cameras bring an arm to a shape, although its model is wrong.

The true arm bends unevenly: each section consists of two arcs with different bends, and the model has one arc. The
estimate from the pictures corrects the command until the arm is seen in the target shape.
"""

# %% The model, and the true arm, which the cameras of the experiment see.
import numpy as np

import flexura

section = {"length": 0.4, "radius": [0.02, 0.02], "max_bend_deg": 120}
uneven = [section | {"bend_profile": [1.0, 1.1]}] * 2
model = {"kind": "spatial", "section": [section] * 2}
experiment = flexura.Experiment(arm=model, truth={"arm": {"section": uneven}})
arm, cameras = experiment.arm, experiment.cameras
photographer = experiment.photographer()

# %% The servo: take pictures, estimate the shape, correct the command.
target = arm.state(bends_deg=[[50, 20], [-30, 60]])
command, errors = arm.state(), []
for step in range(20):
    pictures = [photographer.take(i, command) for i in range(2)]
    seen = arm.estimate(pictures, cameras, near=command)
    if not seen.found:
        raise SystemExit(f"no shape was found: {seen.reason}")
    error = (target - seen.shape)[:, :2]
    errors.append(np.degrees(np.abs(error).max()))
    print(f"step {step}: largest error of a bend {errors[-1]:7.3f} deg")
    if errors[-1] < 0.1:
        break
    command[:, :2] += 0.8 * error
else:
    raise SystemExit("the arm did not reach the target")
print(f"reached after {step} corrections")

# %% The error after each correction, and the last picture of the first camera.
try:
    import matplotlib.pyplot as plt
except ImportError:
    print("no plot: matplotlib is not installed")
else:
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4))
    left.semilogy(errors, "o-")
    left.set(xlabel="corrections", ylabel="largest error of a bend, deg")
    right.imshow(pictures[0], cmap="gray", vmin=0, vmax=255)
    right.set(xlabel="u, px", ylabel="v, px", title="camera 1")
    figure.savefig("servo.png")
