import sys
import threading
import time

import arms
import numpy as np
import pytest

import flexura
from flexura.env import VectorReachEnv, tendon_arm


@pytest.fixture
def no_switches():
    """Python gives the GIL to another thread only where it is released."""
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1000)
    yield
    sys.setswitchinterval(interval)


def long_calls():
    arm = tendon_arm()
    statics, dynamics, batch = flexura.Statics(arm), flexura.Dynamics(arm), flexura.DynamicsBatch(arm, 64)
    state = dynamics.rest()
    experiment = flexura.Experiment(arm={"kind": "spatial", "section": [{"length": 0.5}] * 2})
    photographer = experiment.photographer()
    picture = photographer.take(0, experiment.arm.state(bends_deg=[[30, 0], [0, 20]]))
    two = arms.two_sections()
    states = np.zeros((20000, 2, 3)) + [0.1, 0.2, 1]
    environment = VectorReachEnv(arm, 16)
    return {
        "tip": lambda: two.tip(states),
        "jacobian": lambda: two.jacobian(states),
        # No pose of two sections has this orientation, so the search is long.
        "inverse": lambda: two.inverse([0.3, 0.35, 0.1], rotation=np.eye(3)),
        "inverse_batch": lambda: two.inverse_batch(np.full((50, 3), 0.2)),
        "statics": lambda: statics.solve(tensions=np.ones(9)),
        "solve_batch": lambda: statics.solve_batch(tensions=np.ones((20, 9))),
        "step": lambda: dynamics.step(state, np.ones(9)),
        "batch": lambda: batch.step(tensions=np.ones((64, 9)), steps=10),
        "photograph": lambda: photographer.take(0, experiment.arm.state()),
        "measure": lambda: flexura.measure(picture),
        "environment": lambda: environment.step(np.zeros((16, 9))),
    }


@pytest.mark.parametrize("name", sorted(long_calls()))
def test_long_calls_release_the_gil(name, no_switches):
    call = long_calls()[name]
    turns, is_over = [0], threading.Event()

    def count():
        while not is_over.is_set():
            turns[0] += 1
            time.sleep(0)  # Gives the GIL back.

    other = threading.Thread(target=count)
    other.start()
    # The other thread can run only while a call has released the GIL.
    found = 0
    for _ in range(20000):
        before = turns[0]
        call()
        found = turns[0] - before
        if found > 0:
            break
    is_over.set()
    other.join()
    assert found > 0


def test_threads_may_share_objects(random):
    arm = tendon_arm()
    statics, dynamics = flexura.Statics(arm), flexura.Dynamics(arm)
    photographer = flexura.Experiment(arm={"kind": "spatial", "section": [{"length": 0.5}] * 2}).photographer()
    tensions = random.uniform(0, 2, (8, 9))
    states = np.zeros((2, 3)) + [0.3, 0.1, 1]
    expected = [statics.solve(tensions=pulls).q for pulls in tensions]
    picture = photographer.take(0, states)
    moved = []
    for pulls in tensions:
        state = dynamics.rest()
        for _ in range(10):
            dynamics.step(state, pulls)
        moved.append(state.q)
    errors = []

    def work(i):
        try:
            state = dynamics.rest()
            for _ in range(10):
                dynamics.step(state, tensions[i])
            np.testing.assert_array_equal(state.q, moved[i])
            np.testing.assert_allclose(statics.solve(tensions=tensions[i]).q, expected[i], atol=1e-9)
            np.testing.assert_array_equal(photographer.take(0, states), picture)
        except BaseException as error:
            errors.append(error)

    threads = [threading.Thread(target=work, args=(i,)) for i in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert errors == []


def test_states_are_read_between_steps():
    """Another thread never sees a state within a step."""
    batch = flexura.DynamicsBatch(tendon_arm(), 4)
    alone = flexura.DynamicsBatch(tendon_arm(), 4)
    pulls = np.full((4, 9), 0.5)
    pulls[:, 0] = 3
    possible, found, is_over = {batch.q().tobytes()}, set(), threading.Event()
    for _ in range(40):
        alone.step(tensions=pulls, steps=5)
        possible.add(alone.q().tobytes())

    def read():
        while not is_over.is_set():
            found.add(batch.q().tobytes())

    reader = threading.Thread(target=read)
    reader.start()
    for _ in range(40):
        batch.step(tensions=pulls, steps=5)
    is_over.set()
    reader.join()
    assert found <= possible
    np.testing.assert_array_equal(batch.q(), alone.q())


def test_an_experiment_runs_beside_others(tmp_path):
    text = 'record.report = false\n[arm]\nsection = [{ length = 1 }]\n[[task]]\nkind = "move"\nduration = 0.2\nto.archings = [0.3]\n'
    results = {}

    def run(i):
        results[i] = flexura.Experiment.parse(text).run(tmp_path / str(i), on_state=lambda *_: None)

    threads = [threading.Thread(target=run, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    logs = [(results[i].folder / "log.mcap").read_bytes() for i in range(4)]
    assert len(set(logs)) == 1
