"""Measures calls a second through Python, and the steps a second of many arms.

./dev python python/bench/calls.py [calls] [batch] [pictures] [environments] [--repetitions N]. Without names, all
four. Each takes less than a minute. The column C++ needs `cmake --build build/release --target python_loops`.

Times with one thread are CPU times, which other programs disturb less; those with two threads are wall times. Each is
the least of the repetitions. The overhead is the time of a call for one state, minus the time of a state in a call for
many.
"""

import argparse
import pathlib
import subprocess
import tempfile
import time

import numpy as np

import flexura
from flexura.env import ReachEnv, VectorReachEnv, tendon_arm

ARMS = 64
ROUNDS = 7
repetitions = 7


def seconds(call, count, clock=time.process_time):
    """Returns the least time of a call, of several runs of `count` calls, s."""
    best = float("inf")
    for _ in range(repetitions):
        start = clock()
        for _ in range(count):
            call()
        best = min(best, (clock() - start) / count)
    return best


def clock_of(threads):
    return time.process_time if threads == 1 else time.perf_counter


def scene():
    return flexura.Experiment(arm={"kind": "spatial", "section": [{"length": 0.5}] * 2})


def loops(tensions, positions):
    """Returns the times of the loops in C++, us; empty if python_loops was not built."""
    program = pathlib.Path(flexura.__file__).parents[2] / "bin" / "python_loops"
    if not program.exists():
        return {}
    with tempfile.TemporaryDirectory() as folder:
        files = [pathlib.Path(folder) / name for name in ("arm.toml", "scene.toml", "numbers.txt")]
        files[0].write_text(flexura.Experiment(arm=tendon_arm().table).to_toml())
        files[1].write_text(scene().to_toml())
        files[2].write_text("\n".join(str(value) for value in [*tensions.ravel(), *positions.ravel()]))
        done = subprocess.run([program, *files], check=True, capture_output=True, text=True)
    return {name: float(value) for name, value in (line.split() for line in done.stdout.splitlines())}


def row(name, single, batched, cpp):
    """Prints times of a state, us; `batched` and `cpp` may be None."""
    overhead = f"{single - batched:10.2f}" if batched else f"{single - cpp:10.2f}" if cpp else f"{'':10}"
    many = f"{batched:12.3f}" if batched else f"{'':12}"
    other = f"{cpp:10.3f}{100 * ((batched or single) / cpp - 1):+8.1f} %" if cpp else ""
    print(f"{name:30}{single:12.2f}{many}{overhead}{other}", flush=True)


def calls():
    arm = flexura.Arm(kind="spatial", section=[{"length": 0.3}, {"length": 0.25}, {"length": 0.2}])
    states = np.random.default_rng(1).uniform(-1, 1, (10000, 3, 3))
    states[..., 2] = 1
    tips, jacobians = np.empty((10000, 4, 4)), np.empty((10000, 6, 9))
    positions = arm.tip(states[:200])[:, :3, 3].copy()
    one, tip, jacobian = states[0], tips[0], jacobians[0]
    pulls = np.random.default_rng(1).uniform(0, 3, (ARMS, 9))
    elastic = tendon_arm()
    dynamics = flexura.Dynamics(elastic)
    moving, tensions = [dynamics.rest() for _ in range(ARMS)], list(pulls)

    def loop():
        for state, tension in zip(moving, tensions):
            dynamics.step(state, tension)

    steps = flexura.DynamicsBatch(elastic, ARMS)
    for _ in range(200):
        loop()
    steps.step(tensions=pulls, steps=200)
    photographer = scene().photographer()
    backbone = scene().arm.backbone(np.array([[0.7, 0, 1], [0, 0.87, 1]]))
    # Of each row: the name in C++; a call for one state or a loop of such calls, how often it runs and how many states
    # it has; and the same of a call for many states.
    rows = {
        "forward kinematics": ("tip", (lambda: arm.tip(one, tip), 5000, 1), (lambda: arm.tip(states, tips), 3, 10000)),
        "Jacobian": (
            "jacobian",
            (lambda: arm.jacobian(one, jacobian), 5000, 1),
            (lambda: arm.jacobian(states, jacobians), 3, 10000),
        ),
        "inverse kinematics": (
            "inverse",
            (lambda: [arm.inverse(position) for position in positions], 2, 200),
            (lambda: arm.inverse_batch(positions), 2, 200),
        ),
        f"step, {dynamics.size} unknowns": (
            "step",
            (loop, 10, ARMS),
            (lambda: steps.step(tensions=pulls, steps=20), 1, 20 * ARMS),
        ),
        "picture, 640 x 480": ("picture", (lambda: photographer.take(0, backbone), 10, 1), None),
    }
    # The machine's speed changes within seconds, so Python and C++ run in turn, and the least times count.
    best, cpp = {}, {}
    for _ in range(ROUNDS):
        for name, time_us in loops(pulls, positions).items():
            cpp[name] = min(time_us, cpp.get(name, time_us))
        for name, (_, *timed) in rows.items():
            for place, what in enumerate(timed):
                if what is None:
                    continue
                call, count, items = what
                us = 1e6 * seconds(call, count) / items
                best[name, place] = min(us, best.get((name, place), us))
    print(f"{'':30}{'one, us':>12}{'many, us':>12}{'overhead':>10}{'C++, us':>10}{'against C++':>12}")
    for name, (key, *_) in rows.items():
        row(name, best[name, 0], best.get((name, 1)), cpp.get(key))
    # C++ reads and writes the arrays of NumPy above, and its own types here.
    for name in ("forward kinematics", "Jacobian"):
        row(f"{name}, C++ types", best[name, 0], best[name, 1], cpp.get(f"{rows[name][0]}_own"))


def batch():
    arm = tendon_arm()
    pulls = np.random.default_rng(1).uniform(0, 3, (ARMS, 9))
    changing = np.random.default_rng(2).uniform(0, 3, (100, ARMS, 9))
    # Tensions that change smoothly, as those of a controller.
    phases = np.random.default_rng(3).uniform(0, 6, (ARMS, 9))
    smooth = 1.5 + 1.5 * np.sin(0.06 * np.arange(100)[:, None, None] + phases)
    for tolerance in (1e-7, 1e-4):
        for name, inputs in (("held", [pulls] * 100), ("smooth", smooth), ("new at each step", changing)):
            for threads in (1, 2):
                many = flexura.DynamicsBatch(arm, ARMS, threads, tolerance=tolerance)
                converged = np.empty(ARMS, bool)

                def run():
                    for tension in inputs:
                        many.step(tensions=tension, h=0.01, out=converged)

                run()
                rate = 100 * ARMS / seconds(run, 1, clock_of(threads))
                print(
                    f"steps of 10 ms, tensions {name}, tolerance {tolerance:g}, {threads} threads: {rate:,.0f} a second",
                    flush=True,
                )


def pictures():
    experiment = scene()
    photographer = experiment.photographer()
    backbone = experiment.arm.backbone(experiment.arm.state(bends_deg=[[40, 0], [0, 50]]))
    picture = photographer.take(0, backbone)
    print(f"picture of 640 x 480: {1 / seconds(lambda: photographer.take(0, backbone), 20):,.0f} a second")
    print(f"measure: {1 / seconds(lambda: flexura.measure(picture), 20):,.0f} a second")


def environments():
    arm = tendon_arm()
    actions = np.random.default_rng(1).uniform(-1, 1, (ARMS, 9))
    alone = [ReachEnv(arm) for _ in range(ARMS)]
    for i, env in enumerate(alone):
        env.reset(seed=i)

    def loop():
        for env, action in zip(alone, actions):
            if any(env.step(action)[2:4]):
                env.reset()

    # The wall time with two threads is compared with the loop's; other programs disturb both.
    cpu, wall = (ARMS / seconds(loop, 20, clock) for clock in (time.process_time, time.perf_counter))
    print(f"{ARMS} environments in a loop: {cpu:,.0f} actions a second of CPU time, {wall:,.0f} of wall time", flush=True)
    for threads in (1, 2):
        vector = VectorReachEnv(arm, ARMS, threads=threads)
        vector.reset(seed=1)
        rate = ARMS / seconds(lambda: vector.step(actions), 20, clock_of(threads))
        print(
            f"VectorReachEnv, {ARMS} arms, {threads} threads: {rate:,.0f} actions a second of "
            f"{'CPU' if threads == 1 else 'wall'} time, {rate / (cpu if threads == 1 else wall):.2f} times the loop",
            flush=True,
        )


if __name__ == "__main__":
    parts = {"calls": calls, "batch": batch, "pictures": pictures, "environments": environments}
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parts", nargs="*", metavar="PART", help=", ".join(parts))
    parser.add_argument("--repetitions", type=int, default=repetitions)
    given = parser.parse_args()
    unknown = set(given.parts) - set(parts)
    if unknown:
        parser.error(f"{', '.join(sorted(unknown))}: expected {', '.join(parts)}")
    repetitions = given.repetitions
    for part in given.parts or parts:
        parts[part]()
