"""Runs the parts of the comparison and writes what they found; see run beside this file."""

import argparse
import os
import pathlib
import platform

import cv2
import faiss
import poselib
import pycolmap

import frames
import lenses
import look_up
import photos
import poses
from lodemark import Lodemark
from report import Report

PARTS = ["poses", "lenses", "look_up", "photos", "frames"]


def _arguments():
    parser = argparse.ArgumentParser(prog="test/bench/peers/run")
    parser.add_argument("--root", type=pathlib.Path, required=True, help=argparse.SUPPRESS)
    parser.add_argument("--build", type=pathlib.Path, help="default: build/release")
    parser.add_argument("--data", type=pathlib.Path, help="folder of the recordings")
    parser.add_argument("--parts", default=",".join(PARTS), help="default: %(default)s")
    parser.add_argument("--rounds", type=int, default=5, help="default: %(default)s")
    parser.add_argument("--large", action="store_true", help="also what takes minutes")
    parser.add_argument("--json", type=pathlib.Path, help="also write the figures there")
    arguments = parser.parse_args()
    arguments.parts = arguments.parts.split(",")
    if unknown := set(arguments.parts) - set(PARTS):
        parser.error(f"no part is called {', '.join(sorted(unknown))}")
    if arguments.rounds < 1:
        parser.error("--rounds must be at least 1")
    if arguments.build is None:
        arguments.build = arguments.root / "build" / "release"
    if not (arguments.build / "lib" / "liblodemark.so.1").exists():
        parser.error(f"{arguments.build} holds no lib/liblodemark.so.1: build it, or name --build")
    if arguments.data is None:
        default = arguments.root.parent / "shared" / "data"
        arguments.data = pathlib.Path(os.environ.get("LODEMARK_DATA", default))
    return arguments


def main():
    arguments = _arguments()
    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
    cv2.setNumThreads(1)
    faiss.omp_set_num_threads(1)
    pycolmap.logging.minloglevel = pycolmap.logging.Level.WARNING.value
    library = Lodemark(arguments.build)
    versions = {
        "FAISS": faiss.__version__,
        "OpenCV": cv2.__version__,
        "PoseLib": poselib.__version__,
        "pycolmap": pycolmap.__version__,
        "Python": platform.python_version(),
    }
    print(", ".join(f"{name} {version}" for name, version in versions.items()))
    print("One thread each, by turns; ratio is our time divided by theirs.", flush=True)
    report = Report()
    work = arguments.root / "build" / "peers"
    if "poses" in arguments.parts:
        poses.run(report, library, arguments.rounds, arguments.large)
        report.print_part("poses", poses.TITLE)
    if "lenses" in arguments.parts:
        lenses.run(report, library, arguments.rounds)
        report.print_part("lenses", lenses.TITLE)
    if "look_up" in arguments.parts:
        look_up.run(
            report,
            arguments.build,
            work / "descriptors",
            arguments.data,
            arguments.rounds,
            arguments.large,
        )
        report.print_part("look_up", look_up.TITLE)
    if "photos" in arguments.parts:
        known = photos.run(
            report, library, arguments.build, work / "maps", arguments.data, arguments.rounds
        )
        report.print_part("photos", photos.TITLE)
        if not known:
            print(f"\nPhotographs left out: no recordings in {arguments.data}/vision")
    if "frames" in arguments.parts:
        known = frames.run(
            report, library, arguments.build, work / "maps", arguments.data, arguments.rounds
        )
        report.print_part("frames", frames.TITLE)
        if not known:
            print(f"\nFrames left out: no recordings in {arguments.data}/vision")
    if arguments.json:
        report.write_json(arguments.json, {"versions": versions, "machine": platform.machine()})


if __name__ == "__main__":
    main()
