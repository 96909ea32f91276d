"""Identifies an elastic arm's material from the log of a run.

The run moves an arm whose true material differs from the model. The log has the true positions along the arm and the
tensions of the tendons; noise is added to the positions. The identification compares the equations of motion with them.
"""

# %% The model has the data sheet's modulus; the true arm is stiffer and has more damping.
import pathlib
import tempfile

import numpy as np

import flexura

section = {"length": 0.25, "radius": 0.02, "max_bend_deg": 150, "max_bend_rate_deg": 4000}
modes = {"shear": 0, "stretch": 0, "bend": 3, "twist": 0}
material = {"youngs_modulus": 2.5e5, "poisson": 0.49, "density": 1070, "damping_time": 0.02, "modes": modes}
experiment = flexura.Experiment(
    arm={
        "kind": "spatial",
        "model": "dynamic",
        "gravity": [0, -9.81, 0],
        "time_step": 0.001,
        "base": {"position": [0, 0.5, 0], "rotation": [0, 0, 0.7071067811865476, -0.7071067811865476]},
        "section": [section | {"material": material}],
        "tendon": [{"section": 1, "radius": 0.015, "angle_deg": 120 * i, "compliance": 1e-4} for i in range(3)],
    },
    truth={"arm": {"section": [{"material": {"youngs_modulus": 3.0e5, "damping_time": 0.024}}]}},
    clock={"step": 0.005},
    record={"report": False, "scene": False},
    task=[
        {"kind": "move", "duration": 0.15, "law": "minimum_jerk", "to": {"bends_deg": [[50, 20]]}},
        {"kind": "hold", "duration": 1.5},
    ],
)

# %% The arm moves and swings; the log tells its material.
with tempfile.TemporaryDirectory() as folder:
    run = experiment.run(pathlib.Path(folder) / "run")
    found = experiment.identify(run.folder, noise=2e-4)
    truth = flexura.Log(run.folder).messages("/arm/truth")
modulus, damping = found["values"]
print(f"{found['samples']} times, misfit {found['misfit']:.2f}")
print(f"Young's modulus {modulus['value']:.4g} +- {modulus['sigma']:.1g} Pa, true: 3e+05")
print(f"damping time {damping['value']:.4f} +- {damping['sigma']:.1g} s, true: 0.024")

# %% How the tip swings.
try:
    import matplotlib.pyplot as plt
except ImportError:
    print("no plot: matplotlib is not installed")
else:
    times = [time for time, _ in truth]
    tips = np.array([list(message["poses"][-1]["position"].values()) for _, message in truth])
    figure, axes = plt.subplots()
    axes.plot(times, tips[:, [0, 2]], label=["x", "z"])
    axes.set(xlabel="time, s", ylabel="position of the tip, m", title="The motion that tells the material")
    axes.legend()
    figure.savefig("identification.png")
