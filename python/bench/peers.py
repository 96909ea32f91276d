"""Measures calls of other robotics packages from Python beside those of Flexura, in CPU time.

./dev python python/bench/peers.py. Needs Debian's python3-pykdl (Orocos KDL) and python3-dartpy (DART), and leaves out
what is missing. KDL models each section by 12 rigid links with universal joints (72 joints), as
bench/kinematics_bench.cc. DART models the arm by nine rigid bodies with universal joints: 18 unknowns, as the elastic
arm of flexura.env.tendon_arm.
"""

import itertools
import time

import numpy as np

import flexura
from flexura.env import tendon_arm

LENGTHS = (0.3, 0.25, 0.2)  # m
LINKS = 12  # of a section


def report(name, call, count):
    """Prints the least CPU time of a call, of seven runs of `count` calls."""
    best = float("inf")
    for _ in range(7):
        start = time.process_time()
        for _ in range(count):
            call()
        best = min(best, (time.process_time() - start) / count)
    print(f"{name:62}{1e6 * best:10.2f} us", flush=True)


def kdl():
    try:
        import PyKDL
    except ImportError:
        print("no python3-pykdl")
        return
    chain = PyKDL.Chain()
    for length in LENGTHS:
        for k in range(LINKS):
            axes = (PyKDL.Joint.RotX, PyKDL.Joint.RotY)[:: 1 if k % 2 else -1]
            chain.addSegment(PyKDL.Segment(PyKDL.Joint(axes[0]), PyKDL.Frame()))
            chain.addSegment(PyKDL.Segment(PyKDL.Joint(axes[1]), PyKDL.Frame(PyKDL.Vector(0, 0, length / LINKS))))
    solver, slopes = PyKDL.ChainFkSolverPos_recursive(chain), PyKDL.ChainJntToJacSolver(chain)
    joints, frame, jacobian = PyKDL.JntArray(72), PyKDL.Frame(), PyKDL.Jacobian(72)
    for i in range(72):
        joints[i] = 0.05
    report("KDL: tip of 72 joints", lambda: solver.JntToCart(joints, frame), 2000)
    report("KDL: Jacobian of 72 joints", lambda: slopes.JntToJac(joints, jacobian), 500)
    one = PyKDL.Chain()
    one.addSegment(PyKDL.Segment(PyKDL.Joint(PyKDL.Joint.RotX), PyKDL.Frame(PyKDL.Vector(0, 0, 1))))
    alone, angle = PyKDL.ChainFkSolverPos_recursive(one), PyKDL.JntArray(1)
    report("KDL: tip of one joint (cost of a call)", lambda: alone.JntToCart(angle, frame), 20000)


def dart():
    try:
        import dartpy
    except ImportError:
        print("no python3-dartpy")
        return
    bodies, length = 9, 0.6 / 9
    skeleton, parent = dartpy.dynamics.Skeleton("rod"), None
    mass = 1000 * np.pi * 0.006**2 * length
    stiffness = 5e6 * np.pi * 0.006**4 / 4 / length
    for i in range(bodies):
        joint, body = skeleton.createUniversalJointAndBodyNodePair(parent)
        joint.setName(f"joint {i}")
        body.setName(f"body {i}")
        at = dartpy.math.Isometry3()
        at.set_translation([0, 0, length if i else length / 2])
        joint.setTransformFromParentBodyNode(at)
        for axis in range(2):
            joint.setSpringStiffness(axis, stiffness)
            joint.setDampingCoefficient(axis, 0.02 * stiffness)
        inertia = dartpy.dynamics.Inertia(mass, [0, 0, length / 2], np.diag([mass * length**2 / 12] * 2 + [1e-7]))
        body.setInertia(inertia)
        parent = body
    world = dartpy.simulation.World()
    world.addSkeleton(skeleton)
    world.setTimeStep(0.001)
    skeleton.setPositions(np.full(skeleton.getNumDofs(), 0.05))
    report(f"DART: step of 1 ms, {skeleton.getNumDofs()} unknowns, swinging", world.step, 500)
    report("DART: skeleton.getMass() (cost of a call)", skeleton.getMass, 20000)


def own():
    arm = flexura.Arm(kind="spatial", section=[{"length": length} for length in LENGTHS])
    state = arm.state(bends_deg=[[30, 10]] * 3)
    pose, jacobian = np.empty((4, 4)), np.empty((6, 9))
    report("Flexura: tip of three sections", lambda: arm.tip(state, pose), 20000)
    report("Flexura: Jacobian of three sections", lambda: arm.jacobian(state, jacobian), 20000)
    report("Flexura: arm.sections (cost of a call)", lambda: arm.sections, 20000)
    dynamics = flexura.Dynamics(tendon_arm())
    state, pulls, count = dynamics.rest(), [np.zeros(9), np.array([3.0] + [0] * 8)], itertools.count()
    # The tension jumps twice a second, so that the arm swings.
    report(
        "Flexura: step of 10 ms, 18 unknowns, nine tendons, swinging",
        lambda: dynamics.step(state, pulls[next(count) // 50 % 2]),
        500,
    )


if __name__ == "__main__":
    own()
    kdl()
    dart()
