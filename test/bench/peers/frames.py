"""A frame of 1.2 megapixels in a map of 10,000 landmarks, by stage: features, look-up, pose. From the
recordings of places with surveyed cameras."""

import csv
import json
import subprocess

import cv2
import faiss
import numpy as np
import pycolmap

import lodemark
from photos import CORNER_PX, LARGEST_RATIO, NEIGHBOURS, SCENES, THRESHOLD_PX, read_table
from report import OURS
from turns import median, take_turns

TITLE = "A frame of 1.2 Mpx in a map of 10,000 landmarks, from its grey pixels to the pose, by stage"

PLACE, OTHER = "castle", "fountain"  # landmarks of the other place fill the map up
LANDMARKS = 10_000
PIXELS = 1.2e6


class _Landmarks:
    """The landmarks of both places in one table, and their descriptors."""

    def __init__(self, folders):
        self.rows, ids, found = [], [], []
        for name in (PLACE, OTHER):
            first = len(self.rows)
            rows = read_table(folders[name] / "landmarks.csv.gz")[: LANDMARKS - first]
            number = {int(row["landmark_id"]): first + i for i, row in enumerate(rows)}
            of = np.fromfile(folders[name] / "landmark_descriptor_ids_i32.bin", np.int32)
            bytes_of = np.fromfile(folders[name] / "landmark_descriptors_u8x128.bin", np.uint8)
            kept = np.array([landmark in number for landmark in of])
            ids.append(np.array([number[landmark] for landmark in of[kept]], np.int32))
            found.append(bytes_of.reshape(-1, 128)[kept])
            self.rows += rows
        self.ids, self.descriptors = np.concatenate(ids), np.concatenate(found)

    def write_map(self, build, folder, count):
        folder.mkdir(parents=True, exist_ok=True)
        table, ids = folder / "landmarks.csv", folder / "ids.bin"
        descriptors, path = folder / "descriptors.bin", folder / f"frames_{count}.map"
        names = ["lat_deg", "lon_deg", "h_ell_m"]
        with open(table, "w", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(["landmark_id", *names])
            for i, row in enumerate(self.rows[:count]):
                writer.writerow([i, *(row[name] for name in names)])
        kept = self.ids < count
        self.ids[kept].tofile(ids)
        self.descriptors[kept].tofile(descriptors)
        command = [build / "bin" / "lodemark", "map", "build", "--overwrite", "--out", path]
        command += ["--landmarks", table, "--descriptors", descriptors, "--descriptor-ids", ids]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        return path


class _Ours:
    """Stages as the library's steps give them: features are what asking a map of one landmark takes,
    look-up what asking the whole takes beyond that. The last stage is the second look around the
    pose, which the peer has not."""

    stages = ("features", "look-up", "pose and adjustment", "second look")

    def __init__(self, library, build, landmarks, camera, work):
        self.library = library
        self.maps = [library.open_map(landmarks.write_map(build, work, n)) for n in (1, LANDMARKS)]
        names = ("width_px", "height_px", "fx_px", "fy_px")
        self.lens = lodemark.Lens(
            model=lodemark.PINHOLE,
            **{name: camera[name] for name in names},
            cx_px=camera["cx_px"] - CORNER_PX,
            cy_px=camera["cy_px"] - CORNER_PX,
        )

    def calls(self, picture):
        sights = self.library.query(self.maps[1], self.lens, picture)
        options = lodemark.ResectOptions()
        return {
            "features": lambda: self.library.query(self.maps[0], self.lens, picture),
            "query": lambda: self.library.query(self.maps[1], self.lens, picture),
            "pose and adjustment": lambda: self.library.resect(self.lens, sights, None, options),
            "whole": lambda: self.library.locate(self.maps[1], self.lens, picture),
        }

    @staticmethod
    def split(seconds):
        seconds["look-up"] = seconds["query"] - seconds["features"]
        seconds["second look"] = seconds["whole"] - seconds["query"] - seconds["pose and adjustment"]


class _Pycolmap:
    stages = ("features", "look-up", "pose", "adjustment")

    def __init__(self, landmarks, camera, **sift_options):
        options = pycolmap.FeatureExtractionOptions()
        options.num_threads = 1
        options.use_gpu = False
        for name, value in sift_options.items():
            setattr(options.sift, name, value)
        self.extractor = pycolmap.FeatureExtractor.create(options)
        self.camera = pycolmap.Camera(
            model="PINHOLE",
            width=camera["width_px"],
            height=camera["height_px"],
            params=[camera[name] for name in ("fx_px", "fy_px", "cx_px", "cy_px")],
        )
        names = ("east_m", "north_m", "up_m")
        self.places_m = np.array([[float(row[name]) for name in names] for row in landmarks.rows])
        self.landmark_of = landmarks.ids
        self.index = faiss.IndexFlatL2(128)
        self.index.add(landmarks.descriptors.astype(np.float32))
        self.options = pycolmap.AbsolutePoseEstimationOptions()
        self.options.ransac.max_error = THRESHOLD_PX
        self.options.ransac.random_seed = 1
        self.options.ransac.num_threads = 1

    def _extract(self, picture):
        return self.extractor.extract_from_uint8_array(picture)

    def _match(self, extracted):
        keypoints, found = extracted
        squared, index = self.index.search(found.data.astype(np.float32), NEIGHBOURS)
        landmarks = self.landmark_of[index]
        other = landmarks != landmarks[:, :1]
        second = np.take_along_axis(squared, other.argmax(axis=1)[:, None], axis=1)[:, 0]
        good = other.any(axis=1) & (squared[:, 0] < LARGEST_RATIO**2 * second)
        features = np.flatnonzero(good)
        features = features[np.argsort(squared[features, 0], kind="stable")]
        matched, first = np.unique(landmarks[features, 0], return_index=True)
        pixels = np.array([(keypoints[i].x, keypoints[i].y) for i in features[first]])
        return pixels, self.places_m[matched]

    def _pose(self, matches):
        return pycolmap.estimate_absolute_pose(*matches, self.camera, self.options)

    def _adjust(self, pose, matches):
        return pycolmap.refine_absolute_pose(
            pose["cam_from_world"], *matches, pose["inlier_mask"], self.camera
        )

    def calls(self, picture):
        extracted = self._extract(picture)
        matches = self._match(extracted)
        pose = self._pose(matches)
        return {
            "features": lambda: self._extract(picture),
            "look-up": lambda: self._match(extracted),
            "pose": lambda: self._pose(matches),
            "adjustment": lambda: self._adjust(pose, matches),
        }

    @staticmethod
    def split(seconds):
        seconds["whole"] = sum(seconds.values())


def _scaled(camera, scale):
    """Pixels count from the corner of the first one."""
    names = ("fx_px", "fy_px", "cx_px", "cy_px")
    size = {name: round(camera[name] * scale) for name in ("width_px", "height_px")}
    return {name: camera[name] * scale for name in names} | size


def run(report, library, build, work, data, rounds):
    """False if there are no recordings."""
    folders = {name: data / "vision" / folder for name, folder in SCENES.items()}
    if not all(folder.is_dir() for folder in folders.values()):
        return False
    given = json.loads((folders[PLACE] / "camera.json").read_text())
    scale = (PIXELS / (given["width_px"] * given["height_px"])) ** 0.5
    camera = _scaled(given, scale)
    size = camera["width_px"], camera["height_px"]
    rows = read_table(folders[PLACE] / "cameras_geodetic.csv")
    frames = []
    for name in (row["name"] for row in rows if row["role"] == "query"):
        whole = cv2.imread(str(folders[PLACE] / "images" / name), cv2.IMREAD_GRAYSCALE)
        frames.append(cv2.resize(whole, size, interpolation=cv2.INTER_AREA))
    landmarks = _Landmarks(folders)
    programs = {
        OURS: _Ours(library, build, landmarks, camera, work),
        "pycolmap": _Pycolmap(landmarks, camera),
        "pycolmap, 4000 features, not doubled": _Pycolmap(
            landmarks, camera, max_num_features=4000, first_octave=0
        ),
    }
    seconds = {program: {} for program in programs}
    for frame in frames:
        calls = {
            (key, stage): call
            for key, program in programs.items()
            for stage, call in program.calls(frame).items()
        }
        for (key, stage), times in take_turns(calls, rounds)[0].items():
            seconds[key].setdefault(stage, []).extend(times)
    for key, program in programs.items():
        times = {stage: median(values) for stage, values in seconds[key].items()}
        program.split(times)
        report.add("frames", "whole frame", key, 1e3 * times["whole"])
    for key, program in programs.items():
        times = {stage: median(values) for stage, values in seconds[key].items()}
        program.split(times)
        for stage in program.stages:
            report.add("frames", "stage: " + stage, key, 1e3 * times[stage])
    return True
