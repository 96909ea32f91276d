import arms
import numpy as np
import pytest

import flexura

TEXT = """
[arm]
kind = "spatial"
[[arm.section]]
length = 0.5
max_bend_deg = 120
[[arm.section]]
length = 0.5
max_bend_deg = 120
"""


@pytest.fixture(scope="module")
def experiment():
    return flexura.Experiment.parse(TEXT)


def test_points_are_projected_as_by_a_pinhole(experiment, random):
    for camera in experiment.cameras:
        lens, pose = camera.intrinsics(), camera.pose()
        points = random.uniform(-0.5, 0.5, (20, 3))
        in_camera = (points - pose[:3, 3]) @ pose[:3, :3]
        expected = in_camera[:, :2] / in_camera[:, 2:] * [lens["fx"], lens["fy"]] + [lens["cx"], lens["cy"]]
        assert lens["distortion"] == [0] * 5
        np.testing.assert_allclose(camera.project(points), expected, atol=1e-9)
        behind = pose[:3, 3] - pose[:3, 2]
        assert np.isnan(camera.project(behind)).all() and camera.projection(behind) is None


def test_derivatives_of_a_pixel(experiment):
    camera = experiment.cameras[1]
    point = np.array([0.1, 0.4, -0.2])
    found = camera.projection(point)
    h = 1e-6
    for axis in range(3):
        step = h * np.eye(3)[axis]
        expected = (camera.project(point + step) - camera.project(point - step)) / (2 * h)
        np.testing.assert_allclose(found["by_point"][:, axis], expected, rtol=1e-6)
    moved = [camera.project(point, stance={"pan": sign * h}) for sign in (1, -1)]
    np.testing.assert_allclose(found["by_pan"], (moved[0] - moved[1]) / (2 * h), rtol=1e-6, atol=1e-5)


def test_a_camera_turns_towards_a_point(experiment):
    camera = experiment.cameras[0]
    point = [0.3, 0.2, 0.1]
    stance = camera.looking_at(point)
    lens = camera.intrinsics(stance)
    np.testing.assert_allclose(camera.project(point, stance), [lens["cx"], lens["cy"]], atol=1e-6)
    with pytest.raises(ValueError, match="stance: pam: expected pan, tilt, zoom or stage"):
        camera.pose({"pam": 1})


def test_pictures_are_arrays_without_copies_and_show_the_arm(experiment, random):
    arm = experiment.arm
    photographer = experiment.photographer()
    for state in arms.random_states(random, arm, 3, 0.8):
        backbone = arm.backbone(state)
        for camera in experiment.cameras:
            picture = photographer.take(camera.name, backbone)
            assert picture.shape == (camera.height, camera.width) and picture.dtype == np.uint8
            assert not picture.flags.owndata and picture.flags.writeable
            np.testing.assert_array_equal(picture, photographer.take(camera.name, state))
            seen = flexura.measure(picture)
            assert seen.found and seen.reason == ""
            axis = seen.backbone_image(camera)[seen.seen]
            curve = camera.project(backbone.points(np.linspace(0, 1, 4001)))
            apart = np.linalg.norm(axis[:, None] - curve, axis=2).min(axis=1)
            assert np.sqrt(np.mean(apart**2)) < 0.1


def test_estimates_recover_the_state(experiment, random):
    arm = experiment.arm
    photographer = experiment.photographer()
    cameras = experiment.cameras
    for state in arms.random_states(random, arm, 3, 0.8):
        pictures = [photographer.take(i, state) for i in range(2)]
        found = arm.estimate(pictures, cameras)
        assert found.found, found.reason
        np.testing.assert_allclose(found.shape, state, atol=5e-3)
        measured = [flexura.measure(picture) for picture in pictures]
        np.testing.assert_array_equal(arm.estimate(measured, cameras).shape, found.shape)
        near = arm.estimate(pictures, cameras, near=state[:, :2] + 0.01)
        np.testing.assert_allclose(near.shape[:, :2], found.shape[:, :2], atol=1e-4)


def test_a_blank_picture_has_no_arm(experiment):
    blank = np.full((48, 64), 100, np.uint8)
    seen = flexura.measure(blank)
    assert not seen.found and "blank" in seen.reason and seen.axis.shape == (0, 2)
    found = experiment.arm.estimate([blank, blank], experiment.cameras)
    assert not found.found and found.reason == "no picture shows the arm's axis"


def test_pictures_of_16_bits_and_in_colour_are_measured(experiment):
    picture = experiment.photographer().take(0, experiment.arm.state(bends_deg=[[30, 0], [0, 20]]))
    gray = flexura.measure(picture)
    wide = flexura.measure(picture.astype(np.uint16) * 257)
    np.testing.assert_allclose(wide.axis, gray.axis, atol=0.02)
    color = flexura.measure(np.repeat(picture[..., None], 3, axis=2))
    np.testing.assert_allclose(color.axis, gray.axis, atol=0.02)


@pytest.mark.parametrize("picture", [np.zeros((4, 4)), np.zeros((4, 4), np.int64)])
def test_pictures_of_other_types_are_refused(picture):
    with pytest.raises(TypeError, match="uint8 or uint16"):
        flexura.measure(picture)


@pytest.mark.parametrize("shape", [(4,), (4, 4, 2), (0, 4), (2, 3, 4, 5)])
def test_pictures_of_other_shapes_are_refused(shape):
    with pytest.raises(ValueError, match="picture: "):
        flexura.measure(np.zeros(shape, np.uint8))


def test_noise_depends_on_the_frame_and_the_seed():
    experiment = flexura.Experiment.parse(
        TEXT + '[[camera]]\nname = "one"\nmount = { position = [0, 0.5, 3], look_at = [0, 0.5, 0] }\nsensor.read_noise = 2\n'
    )
    photographer = experiment.photographer()
    state = experiment.arm.state()
    first = photographer.take("one", state)
    np.testing.assert_array_equal(first, photographer.take("one", state, frame=0))
    assert (first != photographer.take("one", state, frame=1)).any()
    assert (first != photographer.take("one", state, seed=2)).any()
    with pytest.raises(ValueError, match='there is no camera "two"'):
        photographer.take("two", state)
