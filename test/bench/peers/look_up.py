"""Looking up descriptors among those of a map, beside FAISS: exact, and in the approximate index
that does best there, inverted lists of 4-bit codes that are refined afterwards."""

import re
import subprocess
import time

import faiss
import numpy as np

import descriptors
from report import OURS
from turns import median

TITLE = (
    f"Nearest two of {descriptors.QUERIES} descriptors (time per 1000): recall of the nearest, and "
    "of the matches of the exact search (nearest within 0.8 of the second)"
)

SIZES = [20_000, 100_000]
LARGE_SIZES = [1_000_000]
SQUARED_RATIO = 0.64
LISTS_TO_VISIT = [4, 8, 12, 16, 20, 24, 32, 48, 64]
ENOUGH = 0.99  # recall of matches, at which the two are compared
REFINED_FROM = 4  # times the two that are asked for
TIMES_IN_A_ROUND = 5  # of which the bench takes the best, so here as well


def _ours(build, base, queries, size):
    """Of each way, seconds, recall of the nearest and of the matches, by the bench's own index."""
    bench = build / "bin" / "descriptor_index_bench"
    command = [bench, base, queries, "--most", str(size), "--visit", "0"]
    lines = subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()
    figures = {}
    for line in lines:
        if found := re.match(
            r"(exact|visit).* ([\d.]+) ms .*recall ([\d.]+).*nearest ([\d.]+)", line
        ):
            figures[found[1]] = (1e-3 * float(found[2]), float(found[4]), float(found[3]))
    if set(figures) != {"exact", "visit"}:
        raise RuntimeError(f"descriptor_index_bench says: {lines}")
    return figures


def _best_seconds(search, times):
    best_s = float("inf")
    for _ in range(times):
        start_s = time.process_time()
        answer = search()
        best_s = min(best_s, time.process_time() - start_s)
    return best_s, answer


class _Faiss:
    def __init__(self, base, queries):
        self.base, self.queries = base.astype(np.float32), queries.astype(np.float32)
        self.flat = faiss.IndexFlatL2(descriptors.BYTES)
        self.flat.add(self.base)
        lists = int(4 * np.sqrt(len(base)))
        self.lists = faiss.index_factory(descriptors.BYTES, f"IVF{lists},PQ64x4fs")
        self.lists.cp.min_points_per_centroid = 1  # or it complains
        self.lists.train(self.base[:: max(1, len(base) // 200_000)])
        self.lists.add(self.base)
        self.refined = faiss.IndexRefineFlat(self.lists, faiss.swig_ptr(self.base))
        self.refined.k_factor = REFINED_FROM
        distance, self.exact_index = self.flat.search(self.queries, 2)
        self.matches = distance[:, 0] < SQUARED_RATIO * distance[:, 1]

    def search_exactly(self):
        return self.flat.search(self.queries, 2)

    def search_quickly(self):
        return self.refined.search(self.queries, 2)

    def recalls(self, answer):
        distance, index = answer
        same = index[:, 0] == self.exact_index[:, 0]
        found = same & self.matches & (distance[:, 0] < SQUARED_RATIO * distance[:, 1])
        return float(same.mean()), float(found.sum() / max(1, self.matches.sum()))

    def visit_enough(self):
        """The fewest lists that find enough."""
        for count in LISTS_TO_VISIT:
            self.lists.nprobe = count
            if self.recalls(self.search_quickly())[1] >= ENOUGH:
                break


def run(report, build, work, data, rounds, large):
    sizes = SIZES + (LARGE_SIZES if large else [])
    base_path, queries_path = descriptors.write_files(work, data, max(sizes))
    base = np.fromfile(base_path, np.uint8).reshape(-1, descriptors.BYTES)
    queries = np.fromfile(queries_path, np.uint8).reshape(-1, descriptors.BYTES)
    source = base_path.name.split("_descriptors")[0].replace("_", " ")
    for size in sizes:
        peer = _Faiss(base[:size], queries)
        peer.visit_enough()
        turns = {}
        for _ in range(rounds):
            ours = _ours(build, base_path, queries_path, size)
            exact_s, exact = _best_seconds(peer.search_exactly, 1)  # as the bench does
            quick_s, quick = _best_seconds(peer.search_quickly, TIMES_IN_A_ROUND)
            for way, name, figures in [
                ("exact", OURS, ours["exact"]),
                ("exact", "FAISS, flat", (exact_s, *peer.recalls(exact))),
                ("approximate", OURS, ours["visit"]),
                (
                    "approximate",
                    f"FAISS, {peer.lists.nprobe} of {peer.lists.nlist} lists",
                    (quick_s, *peer.recalls(quick)),
                ),
            ]:
                turns.setdefault((way, name), []).append(figures)
        for (way, name), figures in turns.items():
            seconds = median([each[0] for each in figures])
            _, recall_at_1, recall_of_matches = figures[-1]
            report.add(
                "look_up",
                f"{size} {source} ({peer.matches.sum()} matches), {way}",
                name,
                1e3 * seconds * 1000 / len(queries),
                recall_at_1=recall_at_1,
                recall_of_matches=recall_of_matches,
            )
