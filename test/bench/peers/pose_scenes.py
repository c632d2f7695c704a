"""Made-up photographs of landmarks with mistaken sights: 1080p, 65 degrees wide, depth 5 to 60 m,
as test/unit/resection/resection_scene.h has them."""

from dataclasses import dataclass

import numpy as np

WIDTH_PX, HEIGHT_PX = 1920, 1080
FOCAL_PX = 1500.0
CENTRE_PX = np.array([959.5, 539.5])
CAMERA_MATRIX = np.array([[FOCAL_PX, 0, CENTRE_PX[0]], [0, FOCAL_PX, CENTRE_PX[1]], [0, 0, 1.0]])
NOISE_PX = 1.0
THRESHOLD_PX = 5.0


@dataclass
class Scene:
    pixels: np.ndarray  # n x 2
    landmarks_m: np.ndarray  # n x 3, east north up
    camera_from_enu: np.ndarray  # rotation
    centre_m: np.ndarray
    up_in_camera: np.ndarray  # as felt by a phone, half a degree of noise on each axis
    position_m: np.ndarray  # as told by satellites, 3 m of noise on each axis


UP_SIGMA_DEG = 0.5
POSITION_SIGMA_M = 3.0


def _turn(axis, angle_rad):
    c, s = np.cos(angle_rad), np.sin(angle_rad)
    turn = np.eye(3)
    i, j = [(1, 2), (2, 0), (0, 1)][axis]
    turn[i, i] = turn[j, j] = c
    turn[i, j], turn[j, i] = -s, s
    return turn


def make_scene(sights, mistaken_share, seed):
    random = np.random.default_rng(seed)
    north = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0.0]])  # camera from ENU, looking north
    rotation = (
        _turn(2, random.uniform(-0.2, 0.2))
        @ _turn(0, random.uniform(-0.2, 0.2))
        @ north
        @ _turn(2, random.uniform(-np.pi, np.pi))
    )
    centre_m = random.uniform([-100, -100, -10], [100, 100, 10])
    size_px = [WIDTH_PX - 1, HEIGHT_PX - 1]
    pixels = random.uniform([0, 0], size_px, (sights, 2))
    depth_m = random.uniform(5.0, 60.0, (sights, 1))
    in_camera_m = np.hstack([(pixels - CENTRE_PX) / FOCAL_PX, np.ones((sights, 1))]) * depth_m
    landmarks_m = in_camera_m @ rotation + centre_m
    pixels += random.normal(0, NOISE_PX, (sights, 2))
    mistaken = random.permutation(sights)[: round(mistaken_share * sights)]
    pixels[mistaken] = random.uniform([0, 0], size_px, (len(mistaken), 2))
    up = rotation @ [0, 0, 1]
    up = up + np.cross(random.normal(0, np.radians(UP_SIGMA_DEG), 3), up)
    position_m = centre_m + random.normal(0, POSITION_SIGMA_M, 3)
    return Scene(pixels, landmarks_m, rotation, centre_m, up, position_m)
