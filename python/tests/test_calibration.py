import numpy as np
import pytest

import flexura

COLUMNS, ROWS, SQUARE = 8, 5, 0.03
BOARD = np.array([[c * SQUARE, r * SQUARE, 0] for r in range(ROWS) for c in range(COLUMNS)])


def turned(vector):
    """Returns the rotation matrix of a rotation vector."""
    angle = np.linalg.norm(vector)
    x, y, z = vector / angle
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def seen(points, lens, k1, k2):
    """Returns the pixels of points in the camera's frame, with radial distortion."""
    fx, fy, cx, cy = lens
    normal = points[:, :2] / points[:, 2:]
    square = (normal**2).sum(axis=1, keepdims=True)
    return normal * (1 + k1 * square + k2 * square**2) * [fx, fy] + [cx, cy]


def test_a_lens_and_a_second_camera_are_recovered(random):
    lenses = [(800, 790, 310, 250), (750, 760, 330, 235)]
    between = turned(np.array([0.05, 0.4, -0.02])), np.array([0.3, 0.02, 0.05])  # X_12
    views = []
    for _ in range(12):
        rotation = turned(random.normal(0, 0.4, 3))
        points = (BOARD - BOARD.mean(axis=0)) @ rotation.T + random.uniform([-0.1, -0.1, 0.5], [0.1, 0.1, 0.8])
        in_second = (points - between[1]) @ between[0]
        views.append([seen(points, lenses[0], -0.2, 0.05), seen(in_second, lenses[1], 0.1, 0.0)])
    found = flexura.fit_intrinsics(views, [(640, 480)] * 2, "chessboard", COLUMNS, ROWS, SQUARE, distortion=2)
    assert found["found"], found["reason"]
    assert found["rms"] < 1e-6 and len(found["boards"]) == 12
    for camera, lens, distortion in zip(found["cameras"], lenses, [(-0.2, 0.05), (0.1, 0)]):
        np.testing.assert_allclose([camera[key] for key in ("fx", "fy", "cx", "cy")], lens, rtol=1e-6)
        np.testing.assert_allclose(camera["distortion"][:2], distortion, atol=1e-6)
        assert camera["covariance"].shape == (9, 9)
    np.testing.assert_allclose(found["cameras"][1]["pose"][:3, :3], between[0], atol=1e-7)
    np.testing.assert_allclose(found["cameras"][1]["pose"][:3, 3], between[1], atol=1e-7)


def drawn_board(pitch=30):
    """Returns a picture of a chessboard with COLUMNS x ROWS inner corners, and these corners."""
    picture = np.full((400, 500), 230, np.uint8)
    for row in range(ROWS + 1):
        for column in range(COLUMNS + 1):
            if (row + column) % 2 == 0:
                top, left = 60 + row * pitch, 70 + column * pitch
                picture[top : top + pitch, left : left + pitch] = 20
    corners = [[70 + (c + 1) * pitch - 0.5, 60 + (r + 1) * pitch - 0.5] for r in range(ROWS) for c in range(COLUMNS)]
    return picture, np.array(corners)


def test_a_board_is_found_in_a_picture():
    picture, corners = drawn_board()
    found, reason = flexura.find_board(picture, columns=COLUMNS, rows=ROWS)
    assert reason == ""
    np.testing.assert_allclose(found, corners, atol=0.05)
    missing, reason = flexura.find_board(np.full((100, 100), 90, np.uint8), columns=COLUMNS, rows=ROWS)
    assert missing.shape == (0, 2) and reason != ""


def test_wrong_arguments_are_refused():
    picture = np.zeros((50, 50), np.uint8)
    with pytest.raises(ValueError, match='pattern: "stars": expected one of "chessboard", "circles"'):
        flexura.find_board(picture, "stars")
    with pytest.raises(ValueError, match="columns and rows: expected at least 3"):
        flexura.find_board(picture, columns=2)
    with pytest.raises(TypeError, match="expected an array of uint8"):
        flexura.find_board(np.zeros((50, 50), np.uint16))
    with pytest.raises(ValueError, match=r"views: expected arrays of shape \(points, 2\), or None"):
        flexura.fit_intrinsics([[np.zeros(3)]], [(640, 480)])
    found = flexura.fit_intrinsics([[None]], [(640, 480)])
    assert not found["found"] and found["reason"]
