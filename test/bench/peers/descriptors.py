"""Root-normalised SIFT descriptors, 128 bytes each, and queries: the same places warped, dimmed and
blurred as another photograph shows them. Of the recorded photographs, or of made-up pictures."""

import cv2
import numpy as np

BYTES = 128
QUERIES = 2000
ASKED_PICTURES = 8  # where the queries come from; the first in the map
ENDINGS = {".jpg", ".jpeg", ".png", ".ppm"}
PICTURES = 400  # made up, where there are no recordings
SEED = 7


def write_files(folder, data, most):
    """Writes at least most descriptors and the queries into folder, unless they are there, and
    gives the two paths."""
    source = "recorded" if _photos(data) else "made_up"
    base, queries = folder / f"{source}_descriptors_{most}.u8", folder / f"{source}_queries.u8"
    if base.exists() and queries.exists():
        return base, queries
    folder.mkdir(parents=True, exist_ok=True)
    random = np.random.default_rng(SEED)
    pictures = _recorded(data) if source == "recorded" else _made_up()
    step = max(1, len(pictures) // ASKED_PICTURES)
    asked = pictures[::step][:ASKED_PICTURES]
    others = [picture for picture in pictures if picture not in asked]
    seen = np.concatenate([_detect(_as_seen_again(load(), random)) for load in asked])
    seen[random.permutation(len(seen))[:QUERIES]].tofile(queries)
    partial = base.with_suffix(".partial")
    count = 0
    with open(partial, "wb") as file:
        # Turned over and as negatives, the same photographs give other descriptors.
        for flip, invert in [(False, False), (True, False), (False, True), (True, True)]:
            for load in asked + others:
                if count >= most:
                    break
                picture = cv2.flip(load(), 1) if flip else load()
                found = _detect(255 - picture if invert else picture)
                found.tofile(file)
                count += len(found)
    partial.replace(base)
    return base, queries


def _photos(data):
    folder = data / "vision"
    return sorted(p for p in folder.rglob("*") if p.suffix.lower() in ENDINGS)


def _recorded(data):
    """Functions that load a photograph each. Of videos and boards, which repeat themselves, few."""
    photos = _photos(data)
    chosen = []
    for recording in sorted((data / "vision").iterdir()):
        of_recording = [photo for photo in photos if recording in photo.parents]
        step = 6 if len(of_recording) > 100 else 3 if "board" in recording.name else 1
        chosen += of_recording[::step]
    return [lambda path=path: cv2.imread(str(path), cv2.IMREAD_GRAYSCALE) for path in chosen]


def _made_up():
    return [lambda seed=seed: _made_up_picture(seed) for seed in range(PICTURES)]


def _made_up_picture(seed):
    """Noise at all scales under polygons."""
    random = np.random.default_rng(seed)
    height_px, width_px = 768, 1024
    picture = np.zeros((height_px, width_px), np.float32)
    for cells in (4, 8, 16, 32, 64, 128, 256):
        noise = random.normal(0, 60 / np.sqrt(cells), (cells * 3 // 4, cells)).astype(np.float32)
        picture += cv2.resize(noise, (width_px, height_px), interpolation=cv2.INTER_CUBIC)
    for _ in range(60):
        corners = random.integers([0, 0], [width_px, height_px]) + random.integers(-90, 90, (4, 2))
        cv2.fillConvexPoly(picture, corners.astype(np.int32), float(random.normal(0, 40)))
    picture += random.normal(0, 3, picture.shape)
    return np.clip(picture + 128, 0, 255).astype(np.uint8)


_sift = cv2.SIFT_create(nfeatures=0, contrastThreshold=0.02)


def _detect(picture):
    _, found = _sift.detectAndCompute(picture, None)
    if found is None:
        return np.zeros((0, BYTES), np.uint8)
    found = found.astype(np.float64)
    found /= np.maximum(found.sum(axis=1, keepdims=True), 1e-9)
    return np.clip(np.rint(512 * np.sqrt(found)), 0, 255).astype(np.uint8)


def _as_seen_again(picture, random):
    height_px, width_px = picture.shape
    scale, angle_rad = random.uniform(0.75, 1.3), random.uniform(-0.4, 0.4)
    c, s = scale * np.cos(angle_rad), scale * np.sin(angle_rad)
    stretch = random.uniform(0.85, 1.15)
    tilt = random.uniform(-1.5e-4, 1.5e-4, 2)
    to_middle = np.array([[1, 0, -width_px / 2], [0, 1, -height_px / 2], [0, 0, 1]])
    warp = np.array([[c, -s, 0], [s, c * stretch, 0], [*tilt, 1]])
    warp = np.linalg.inv(to_middle) @ warp @ to_middle
    again = cv2.warpPerspective(picture, warp, (width_px, height_px)).astype(np.float32)
    again = cv2.GaussianBlur(again, (0, 0), random.uniform(0.3, 1.0)) * random.uniform(0.7, 1.2)
    again += random.uniform(-10, 20) + random.normal(0, 5, again.shape)
    return np.clip(again, 0, 255).astype(np.uint8)
