"""Undistortion of points spread over the image, and the way back, beside OpenCV and pycolmap."""

from dataclasses import dataclass

import cv2
import numpy as np
import pycolmap

import lodemark
from report import OURS
from turns import median, take_turns

POINTS = 100_000
WIDTH_PX, HEIGHT_PX = 1000, 700
CENTRE_PX = (505.0, 340.0)
OFF_PX = 0.01

TITLE = (
    f"Undistortion of {POINTS} points over the image (time of all): points refused, points more "
    f"than {OFF_PX} px off after the way back though not refused, and the largest such error"
)


@dataclass
class Example:
    model: int
    focal_px: float
    coefficients: tuple  # in OpenCV's order
    colmap_model: str


EXAMPLES = {
    "radial": Example(lodemark.BROWN, 800.0, (-0.28, 0.09, 0, 0), "OPENCV"),
    "wide radial": Example(lodemark.BROWN, 400.0, (-0.3, 0.08, 0, 0), "OPENCV"),
    "Brown": Example(
        lodemark.BROWN, 800.0, (-0.266, -0.0386, 1.78e-3, -2.8e-4, 0.238), "FULL_OPENCV"
    ),
    "rational": Example(
        lodemark.BROWN, 400.0, (0.9, 0.2, 1e-4, 2e-4, 0.01, 1.25, 0.45, 0.05), "FULL_OPENCV"
    ),
    "folding in view": Example(lodemark.BROWN, 400.0, (-0.15, 0, 0, 0), "OPENCV"),
    "fisheye": Example(lodemark.FISHEYE, 320.0, (-0.02, 0.006, -0.004, 0.0005), "OPENCV_FISHEYE"),
    "thin prism": Example(
        lodemark.THIN_PRISM_FISHEYE,
        320.0,
        (-0.02, 0.005, 1e-3, -2e-3, 1e-3, -2e-4, 3e-3, -1e-3),
        "THIN_PRISM_FISHEYE",
    ),
}


def _pixels():
    """Even over the image, in no order that a cache would like: the plastic sequence of Roberts."""
    steps = np.outer(np.arange(POINTS), [0.7548776662466927, 0.5698402909980532])
    return (steps % 1.0) * [WIDTH_PX, HEIGHT_PX]


# Each gives a function that undistorts all pixels and one that brings its answer back to pixels,
# not a number where the answer says that there is none.


def _ours(library, example, pixels):
    lens = lodemark.Lens(
        model=example.model,
        width_px=WIDTH_PX,
        height_px=HEIGHT_PX,
        fx_px=example.focal_px,
        fy_px=example.focal_px,
        cx_px=CENTRE_PX[0],
        cy_px=CENTRE_PX[1],
        coefficients=example.coefficients,
    )
    directions, valid = np.zeros((POINTS, 3)), np.zeros(POINTS, np.uint8)

    def way_back(_):
        again = library.project(lens, np.where(valid[:, None], directions, [0.0, 0.0, 1.0]))
        again[valid == 0] = np.nan
        return again

    return lambda: library.unproject(lens, pixels, directions, valid), way_back


def _opencv(example, pixels, criteria):
    f_px = example.focal_px
    matrix = np.array([[f_px, 0, CENTRE_PX[0]], [0, f_px, CENTRE_PX[1]], [0, 0, 1]])
    coefficients = np.array(example.coefficients)
    points = pixels.reshape(-1, 1, 2)
    zero = np.zeros(3)
    options = {} if criteria is None else {"criteria": criteria}
    if example.model == lodemark.FISHEYE:
        undistort_points = cv2.fisheye.undistortPoints

        def project(rays):
            return cv2.fisheye.projectPoints(rays, zero, zero, matrix, coefficients)[0]

    else:
        undistort_points = cv2.undistortPoints

        def project(rays):
            return cv2.projectPoints(rays, zero, zero, matrix, coefficients)[0]

    def undistort():
        return undistort_points(points, matrix, coefficients, **options)

    def way_back(answer):
        rays = np.concatenate([answer, np.ones((POINTS, 1, 1))], axis=2)
        again = project(rays).reshape(-1, 2)
        # OpenCV's fisheye says so with this number.
        again[(answer == -1e6).reshape(-1, 2).all(axis=1)] = np.nan
        return again

    return undistort, way_back


def _pycolmap(example, pixels):
    coefficients = example.coefficients
    if example.colmap_model == "FULL_OPENCV":
        coefficients += (0.0,) * (8 - len(coefficients))
    camera = pycolmap.Camera(
        model=example.colmap_model,
        width=WIDTH_PX,
        height=HEIGHT_PX,
        params=[example.focal_px, example.focal_px, *CENTRE_PX, *coefficients],
    )

    def way_back(answer):
        known = np.isfinite(answer).all(axis=1)
        again = np.full((POINTS, 2), np.nan)
        again[known] = camera.img_from_cam(answer[known], check_cheirality=False)
        return again

    return lambda: camera.cam_ray_from_img(pixels), way_back


def run(report, library, rounds):
    pixels = _pixels()
    tight = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 100, 1e-12)
    for problem, example in EXAMPLES.items():
        programs = {OURS: _ours(library, example, pixels)}
        if example.model != lodemark.THIN_PRISM_FISHEYE:  # which OpenCV does not have
            programs["OpenCV"] = _opencv(example, pixels, None)
            programs["OpenCV, to 1e-12"] = _opencv(example, pixels, tight)
        programs["pycolmap"] = _pycolmap(example, pixels)
        seconds, answers = take_turns({name: p[0] for name, p in programs.items()}, rounds)
        for name, (_, way_back) in programs.items():
            error_px = np.linalg.norm(way_back(answers[name]) - pixels, axis=1)
            answered = np.isfinite(error_px)
            off = error_px[answered] > OFF_PX
            report.add(
                "lenses",
                problem,
                name,
                1e3 * median(seconds[name]),
                refused=f"{100 * (1 - answered.mean()):.1f} %",
                off=f"{100 * off.sum() / POINTS:.1f} %",
                largest_px=float(error_px[answered].max()),
            )
