import os
import pathlib

import numpy as np
import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[2]


def pytest_configure(config):
    config.addinivalue_line("markers", "slow: takes seconds, or starts programs; left out with sanitizers")


@pytest.fixture
def random(request):
    """Random numbers with a seed that depends on the test's name; a failing test prints it."""
    seed = sum(request.node.name.encode())
    print(f"seed {seed}")
    return np.random.default_rng(seed)


@pytest.fixture
def examples():
    return SOURCE / "examples"


@pytest.fixture
def program():
    """The program flexura, with which results are compared."""
    path = os.environ.get("FLEXURA_PROGRAM")
    if not path:
        pytest.skip("skipped: needs FLEXURA_PROGRAM")
    return path
