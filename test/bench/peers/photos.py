"""Where a photograph was taken: Lodemark's map beside pycolmap's features and pose with an exact
search between, on the same landmarks. From the recordings of places with surveyed cameras."""

import csv
import gzip
import json
import shutil
import subprocess
from functools import partial

import cv2
import faiss
import numpy as np
import pycolmap

import lodemark
from report import OURS
from turns import median, take_turns

TITLE = (
    "Where a photograph was taken (time of one, from its grey pixels to the pose): error of the "
    "camera's centre"
)

SCENES = {"fountain": "strecha_fountain_p11", "castle": "strecha_castle_p19"}
# These recordings count pixels from the corner of the first pixel, as COLMAP does.
CORNER_PX = 0.5
LARGEST_RATIO = 0.8
NEIGHBOURS = 16  # a landmark has several descriptors, and the second nearest must be of another
THRESHOLD_PX = 4.0


def read_table(path):
    open_text = gzip.open if path.suffix == ".gz" else open
    with open_text(path, "rt") as file:
        return list(csv.DictReader(file))


def _enu_m(row):
    return np.array([float(row[name]) for name in ("east_m", "north_m", "up_m")])


class _Scene:
    def __init__(self, folder):
        self.folder = folder
        self.camera = json.loads((folder / "camera.json").read_text())
        cameras = read_table(folder / "cameras_geodetic.csv")
        self.queries = [row for row in cameras if row["role"] == "query"]
        self.pictures = {
            row["name"]: cv2.imread(str(folder / "images" / row["name"]), cv2.IMREAD_GRAYSCALE)
            for row in self.queries
        }


class _Ours:
    def __init__(self, library, build, scene, work):
        work.mkdir(parents=True, exist_ok=True)
        path, landmarks = work / "landmarks.map", work / "landmarks.csv"
        with gzip.open(scene.folder / "landmarks.csv.gz") as source, open(landmarks, "wb") as out:
            shutil.copyfileobj(source, out)
        command = [build / "bin" / "lodemark", "map", "build", "--overwrite", "--out", path]
        command += ["--landmarks", landmarks]
        command += ["--descriptors", scene.folder / "landmark_descriptors_u8x128.bin"]
        command += ["--descriptor-ids", scene.folder / "landmark_descriptor_ids_i32.bin"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        self.library = library
        self.map = library.open_map(path)
        camera = scene.camera
        self.lens = lodemark.Lens(
            model=lodemark.PINHOLE,
            width_px=camera["width_px"],
            height_px=camera["height_px"],
            fx_px=camera["fx_px"],
            fy_px=camera["fy_px"],
            cx_px=camera["cx_px"] - CORNER_PX,
            cy_px=camera["cy_px"] - CORNER_PX,
        )

    def locate(self, picture):
        return self.library.locate(self.map, self.lens, picture)

    def error_m(self, pose, truth):
        if pose is None:
            return None
        geodetic = [float(truth[name]) for name in ("lat_deg", "lon_deg", "h_ell_m")]
        return np.linalg.norm(np.array(pose.ecef_m) - self.library.ecef_from_geodetic(geodetic))


class _Pycolmap:
    def __init__(self, scene, **sift_options):
        options = pycolmap.FeatureExtractionOptions()
        options.num_threads = 1
        options.use_gpu = False
        for name, value in sift_options.items():
            setattr(options.sift, name, value)
        self.extractor = pycolmap.FeatureExtractor.create(options)
        camera = scene.camera
        self.camera = pycolmap.Camera(
            model="PINHOLE",
            width=camera["width_px"],
            height=camera["height_px"],
            params=[camera[name] for name in ("fx_px", "fy_px", "cx_px", "cy_px")],
        )
        rows = read_table(scene.folder / "landmarks.csv.gz")
        self.places_m = np.array([_enu_m(row) for row in rows])
        place_of = {int(row["landmark_id"]): i for i, row in enumerate(rows)}
        ids = np.fromfile(scene.folder / "landmark_descriptor_ids_i32.bin", np.int32)
        self.landmark_of = np.array([place_of[landmark_id] for landmark_id in ids])
        found = np.fromfile(scene.folder / "landmark_descriptors_u8x128.bin", np.uint8)
        self.index = faiss.IndexFlatL2(128)
        self.index.add(found.reshape(-1, 128).astype(np.float32))
        self.options = pycolmap.AbsolutePoseEstimationOptions()
        self.options.ransac.max_error = THRESHOLD_PX
        self.options.ransac.random_seed = 1
        self.options.ransac.num_threads = 1

    def _matches(self, found):
        """For each landmark that is matched, the nearest feature."""
        squared, index = self.index.search(found, NEIGHBOURS)
        landmarks = self.landmark_of[index]
        other = landmarks != landmarks[:, :1]
        second = np.take_along_axis(squared, other.argmax(axis=1)[:, None], axis=1)[:, 0]
        good = other.any(axis=1) & (squared[:, 0] < LARGEST_RATIO**2 * second)
        features = np.flatnonzero(good)
        features = features[np.argsort(squared[features, 0], kind="stable")]
        matched, first = np.unique(landmarks[features, 0], return_index=True)
        return features[first], matched

    def locate(self, picture):
        keypoints, found = self.extractor.extract_from_uint8_array(picture)
        features, matched = self._matches(found.data.astype(np.float32))
        pixels = np.array([(keypoints[i].x, keypoints[i].y) for i in features])
        return pycolmap.estimate_and_refine_absolute_pose(
            pixels, self.places_m[matched], self.camera, self.options
        )

    def error_m(self, answer, truth):
        if answer is None:
            return None
        pose = answer["cam_from_world"]
        return np.linalg.norm(-pose.rotation.matrix().T @ pose.translation - _enu_m(truth))


def run(report, library, build, work, data, rounds):
    """False if there are no recordings."""
    folders = {name: data / "vision" / folder for name, folder in SCENES.items()}
    folders = {name: folder for name, folder in folders.items() if folder.is_dir()}
    for name, folder in folders.items():
        scene = _Scene(folder)
        programs = {
            OURS: _Ours(library, build, scene, work / folder.name),
            "pycolmap": _Pycolmap(scene),
            "pycolmap, 4000 features, not doubled": _Pycolmap(
                scene, max_num_features=4000, first_octave=0
            ),
        }
        seconds = {program: [] for program in programs}
        errors_m = {program: [] for program in programs}
        for truth in scene.queries:
            picture = scene.pictures[truth["name"]]
            photo_seconds, answers = take_turns(
                {key: partial(program.locate, picture) for key, program in programs.items()}, rounds
            )
            for key, program in programs.items():
                seconds[key] += photo_seconds[key]
                errors_m[key].append(program.error_m(answers[key], truth))
        for key in programs:
            known_m = [error_m for error_m in errors_m[key] if error_m is not None]
            report.add(
                "photos",
                name,
                key,
                1e3 * median(seconds[key]),
                located=f"{len(known_m)} of {len(scene.queries)}",
                mean_cm=100 * float(np.mean(known_m)) if known_m else None,
                worst_cm=100 * float(np.max(known_m)) if known_m else None,
            )
    return bool(folders)
