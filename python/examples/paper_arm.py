"""The paper's arm bends: its tip reaches E = (-10.738, 5.201), as in the paper's Fig. 8."""

# %% An arm of eight sections in a plane, and the angles of their cords from the X axis.
import numpy as np

import flexura

lengths = [2, 3, 1, 2, 4, 2, 1, 1]  # m
arm = flexura.Arm(kind="planar", section=[{"length": length} for length in lengths])
state = arm.state(cord_angles_pi=[0.55, 0.65, 0.8, 1.0, 1.15, 0.9, 0.8, 0.65])
x, y, _ = arm.tip(state)[:3, 3]
print(f"E = ({x:.3f}, {y:.3f})")

# %% The arm, with the ends of its sections.
try:
    import matplotlib.pyplot as plt
except ImportError:
    print("no plot: matplotlib is not installed")
else:
    points = arm.points(state, np.linspace(0, 1, 300))
    ends = arm.frames(state)[:, :3, 3]
    figure, axes = plt.subplots()
    axes.plot(points[:, 0], points[:, 1])
    axes.plot(ends[:, 0], ends[:, 1], "o")
    axes.annotate("E", ends[-1, :2], xytext=(8, -4), textcoords="offset points")
    axes.set(aspect="equal", xlabel="X, m", ylabel="Y, m", title="The paper's arm")
    figure.savefig("paper_arm.png")
