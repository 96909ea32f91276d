"""A campaign: how far does a wrong length of a section bring the tip from its target?

A Monte Carlo campaign runs one experiment with many lengths and seeds. Its table comes back as NumPy arrays.
"""

# %% One experiment, in which the true arm may differ from the model.
import pathlib
import tempfile

import numpy as np

import flexura

section = {"length": 0.3, "max_bend_deg": 120}
experiment = flexura.Experiment(
    arm={"kind": "spatial", "section": [section] * 2},
    task=[{"kind": "move", "duration": 0.2, "to": {"bends_deg": [[60, 0], [0, 90]]}}],
)

# %% Two hundred runs with lengths that are wrong by 2 %.
lengths = [
    {"kind": "normal", "path": f"arm.section.{i}.length", "name": f"length_{i + 1}", "mean": 0.3, "sigma": 0.006}
    for i in range(2)
]
campaign = flexura.Campaign(
    experiment,
    sampling="sobol",
    samples=200,
    parameter=lengths,
    measure=[{"key": f"tip.position.{i}", "name": f"tip_{'xyz'[i]}"} for i in range(3)],
)
with tempfile.TemporaryDirectory() as folder:
    results = campaign.run(pathlib.Path(folder) / "lengths.db").results
    table = results.table()
    shares = [results.sensitivity("tip_y", f"length_{i + 1}")["share"] for i in range(2)]
nominal = experiment.arm.tip(experiment.arm.state(bends_deg=[[60, 0], [0, 90]]))[:3, 3]
tips = np.column_stack([table[f"tip_{axis}"] for axis in "xyz"])
distances = np.linalg.norm(tips - nominal, axis=1)
print(f"{campaign.runs} runs; the height depends on length 1 by {shares[0]:.0%}, on length 2 by {shares[1]:.0%}")
print(f"the tip is {1000 * np.sqrt(np.mean(distances**2)):.1f} mm from its target (rms)")

# %% Where the tips are.
try:
    import matplotlib.pyplot as plt
except ImportError:
    print("no plot: matplotlib is not installed")
else:
    figure, axes = plt.subplots()
    points = axes.scatter(1000 * tips[:, 0], 1000 * tips[:, 1], c=1000 * table["length_1"], s=12)
    axes.plot(*(1000 * nominal[:2]), "k+", markersize=14)
    axes.set(aspect="equal", xlabel="X, mm", ylabel="Y, mm", title="Tips of 200 arms")
    figure.colorbar(points, label="length of section 1, mm")
    figure.savefig("campaign.png")
