"""The pose of a camera from matched points, many of them mistaken, beside PoseLib, OpenCV's and
pycolmap's robust solvers."""

from functools import partial

import cv2
import numpy as np
import poselib
import pycolmap

import lodemark
import pose_scenes
from pose_scenes import CAMERA_MATRIX, CENTRE_PX, FOCAL_PX, HEIGHT_PX, THRESHOLD_PX, WIDTH_PX
from report import OURS
from turns import median, take_turns

TITLE = (
    "Poses from matched points (1080p, 1 px of noise, 5 to 60 m, 5 px threshold): scenes solved "
    "within 10 cm, and the median error of their centres"
)

# Sights, share mistaken, scenes. The C interface takes at most 4096 sights.
CELLS = [
    (50, 0.0, 50),
    (50, 0.2, 50),
    (200, 0.4, 50),
    (200, 0.8, 30),
    (1000, 0.6, 30),
    (4000, 0.4, 10),
    (1000, 0.9, 20),
    (1000, 0.95, 10),
]
LARGE_CELLS = [(4000, 0.98, 4)]
PRIOR_CELLS = [(200, 0.8, 30), (1000, 0.95, 30), (4000, 0.98, 20)]
SOLVED_M = 0.1
MOST_SAMPLES = 100_000
CONFIDENCE = 0.9999

# East, north, up at latitude and longitude zero are y, z, x of ECEF.
EQUATOR_M = 6378137.0


def _ecef(enu_m):
    return np.stack([enu_m[..., 2] + EQUATOR_M, enu_m[..., 0], enu_m[..., 1]], axis=-1)


def _enu(ecef_m):
    return np.array([ecef_m[1], ecef_m[2], ecef_m[0] - EQUATOR_M])


def _our_lens():
    return lodemark.Lens(
        model=lodemark.PINHOLE,
        width_px=WIDTH_PX,
        height_px=HEIGHT_PX,
        fx_px=FOCAL_PX,
        fy_px=FOCAL_PX,
        cx_px=CENTRE_PX[0],
        cy_px=CENTRE_PX[1],
    )


def _ours(library, scene, with_priors=False):
    sights = np.zeros(len(scene.pixels), lodemark.SIGHT)
    sights["struct_size"] = lodemark.SIGHT.itemsize
    sights["pixel_px"] = scene.pixels
    sights["landmark_in_ecef_m"] = _ecef(scene.landmarks_m)
    prior = None
    if with_priors:
        variance_m2 = pose_scenes.POSITION_SIGMA_M**2
        prior = lodemark.ViewPrior(
            present=lodemark.HAS_POSITION | lodemark.HAS_GRAVITY,
            position_in_ecef_m=tuple(_ecef(scene.position_m)),
            position_covariance_enu_m2=tuple((variance_m2 * np.eye(3)).ravel()),
            up_in_camera=tuple(scene.up_in_camera),
            up_sigma_deg=pose_scenes.UP_SIGMA_DEG,
        )
    lens, options = _our_lens(), lodemark.ResectOptions(inlier_threshold_px=THRESHOLD_PX)

    def solve():
        pose = library.resect(lens, sights, prior, options)
        return None if pose is None else _enu(pose.ecef_m)

    return solve


def _poselib(scene, **more_options):
    camera = {
        "model": "PINHOLE",
        "width": WIDTH_PX,
        "height": HEIGHT_PX,
        "params": [FOCAL_PX, FOCAL_PX, *CENTRE_PX],
    }
    options = {
        "max_reproj_error": THRESHOLD_PX,
        "max_iterations": MOST_SAMPLES,
        "success_prob": CONFIDENCE,
    } | more_options

    def solve():
        pose, _ = poselib.estimate_absolute_pose(
            scene.pixels, scene.landmarks_m, camera, options, {}
        )
        return -pose.R.T @ pose.t

    return solve


def _opencv(scene, flags, refine):
    def solve():
        cv2.setRNGSeed(1)
        found, rotation, translation, inliers = cv2.solvePnPRansac(
            scene.landmarks_m,
            scene.pixels,
            CAMERA_MATRIX,
            None,
            iterationsCount=MOST_SAMPLES,
            reprojectionError=THRESHOLD_PX,
            confidence=CONFIDENCE,
            flags=flags,
        )
        if not found or inliers is None:
            return None
        if refine:
            rows = inliers.ravel()
            rotation, translation = cv2.solvePnPRefineLM(
                scene.landmarks_m[rows],
                scene.pixels[rows],
                CAMERA_MATRIX,
                None,
                rotation,
                translation,
            )
        return -(cv2.Rodrigues(rotation)[0].T @ translation).ravel()

    return solve


def _pycolmap(scene):
    camera = pycolmap.Camera(
        model="PINHOLE",
        width=WIDTH_PX,
        height=HEIGHT_PX,
        params=[FOCAL_PX, FOCAL_PX, *CENTRE_PX],
    )
    options = pycolmap.AbsolutePoseEstimationOptions()
    options.ransac.max_error = THRESHOLD_PX
    options.ransac.max_num_trials = MOST_SAMPLES
    options.ransac.min_inlier_ratio = 0.01
    options.ransac.confidence = CONFIDENCE
    options.ransac.random_seed = 1
    options.ransac.num_threads = 1

    def solve():
        answer = pycolmap.estimate_and_refine_absolute_pose(
            scene.pixels, scene.landmarks_m, camera, options
        )
        if answer is None:
            return None
        pose = answer["cam_from_world"]
        return -pose.rotation.matrix().T @ pose.translation

    return solve


def _peers(scene):
    return {
        "PoseLib": _poselib(scene),
        "PoseLib, from 100 samples": _poselib(scene, min_iterations=100),  # its default is 1000
        "OpenCV, P3P and LM": _opencv(scene, cv2.SOLVEPNP_P3P, refine=True),
        "OpenCV, MAGSAC": _opencv(scene, cv2.USAC_MAGSAC, refine=False),
        "pycolmap": _pycolmap(scene),
    }


# These cannot take mistaken points.
def _plain_solvers(scene):
    def solve_with(flags):
        def solve():
            found, rotation, translation = cv2.solvePnP(
                scene.landmarks_m, scene.pixels, CAMERA_MATRIX, None, flags=flags
            )
            return -(cv2.Rodrigues(rotation)[0].T @ translation).ravel() if found else None

        return solve

    return {
        "OpenCV, solvePnP iterative": solve_with(cv2.SOLVEPNP_ITERATIVE),
        "OpenCV, solvePnP SQPNP": solve_with(cv2.SOLVEPNP_SQPNP),
    }


def _programs(library, some_mistaken, scene):
    plain = {} if some_mistaken else _plain_solvers(scene)
    return {OURS: _ours(library, scene)} | plain | _peers(scene)


def _run_cell(report, problem, scenes, programs_of, rounds):
    seconds, errors_m = {}, {}
    for scene in scenes:
        scene_seconds, centres = take_turns(programs_of(scene), rounds)
        for name, values in scene_seconds.items():
            seconds.setdefault(name, []).extend(values)
            centre_m = centres[name]
            error_m = np.inf if centre_m is None else np.linalg.norm(centre_m - scene.centre_m)
            errors_m.setdefault(name, []).append(error_m)
    for name in seconds:
        solved_m = [error_m for error_m in errors_m[name] if error_m < SOLVED_M]
        report.add(
            "poses",
            problem,
            name,
            1e3 * median(seconds[name]),
            centre_cm=100 * float(median(solved_m)) if solved_m else None,
            solved=f"{len(solved_m)} of {len(scenes)}",
        )


def run(report, library, rounds, large):
    for sights, share, count in CELLS + (LARGE_CELLS if large else []):
        scenes = [pose_scenes.make_scene(sights, share, 1000 + k) for k in range(count)]
        _run_cell(
            report,
            f"{sights}, {100 * share:.0f} %",
            scenes,
            partial(_programs, library, share > 0.0),
            1 if share >= 0.9 else rounds,
        )
    for sights, share, count in PRIOR_CELLS:
        scenes = [pose_scenes.make_scene(sights, share, 1000 + k) for k in range(count)]
        _run_cell(
            report,
            f"{sights}, {100 * share:.0f} %, gravity and place known",
            scenes,
            lambda scene: {OURS: _ours(library, scene, with_priors=True)},
            rounds,
        )
