"""Arms of the tests."""

import flexura


def two_sections(**keys):
    return flexura.Arm(kind="spatial", section=[{"length": 0.3}, {"length": 0.25}], **keys)


def stretching():
    section = {"length": 0.3, "stretch_limits": [0.8, 1.3], "max_bend_deg": 120}
    return flexura.Arm(kind="spatial", section=[section] * 3)


def uneven():
    """Sections of several arcs, which bend differently."""
    sections = [{"length": 0.3, "bend_profile": [1, 2, 1]}, {"length": 0.2, "bend_profile": [3, 1]}]
    return flexura.Arm(kind="spatial", section=sections)


def rod(length=0.5, tendons=(), load=None, **material):
    """A thin elastic rod that bends only, without weight."""
    keys = {
        "youngs_modulus": 1e9,
        "density": 1000,
        "radius": [0.002, 0.002],
        "modes": {"shear": 0, "stretch": 0, "bend": 7, "twist": 0},
    } | material
    table = {"section": [{"length": length, "material": keys}], "tendon": list(tendons)}
    if load:
        table["load"] = [load]
    return flexura.Arm(kind="spatial", model="static", **table)


def random_states(random, arm, count, largest=1.5):
    """Returns states (count, sections, 3) with bends up to `largest` and stretches within the limits."""
    import numpy as np

    low, high = arm.stretch_limits.T
    bends = random.uniform(-largest, largest, (count, arm.sections, 2))
    stretches = random.uniform(low, high, (count, arm.sections))
    return np.concatenate([bends, stretches[..., None]], axis=2)
