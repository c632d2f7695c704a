"""The part of the C interface (lodemark.h) that is measured, by ctypes."""

import ctypes
from ctypes import byref, c_char_p, c_double, c_int32, c_int64, c_uint32, c_uint64, c_void_p

import numpy as np

PINHOLE, BROWN, FISHEYE, THIN_PRISM_FISHEYE = range(4)
GOOD, NO_POSITION = 0, 2  # of the statuses; those below zero are errors
HAS_POSITION, HAS_GRAVITY = 0x1, 0x2
LARGEST_COUNT = 4096

SIGHT = np.dtype(
    [
        ("struct_size", np.uint32),
        ("present", np.uint32),
        ("landmark_id", np.uint32),
        ("reserved", np.int32),
        ("pixel_px", np.float64, 2),
        ("sigma_px", np.float64),
        ("landmark_in_ecef_m", np.float64, 3),
        ("landmark_covariance_enu_m2", np.float64, 9),
        ("quality", np.float64),
    ]
)


class _Sized(ctypes.Structure):
    def __init__(self, **fields):
        super().__init__(struct_size=ctypes.sizeof(type(self)), **fields)


class Lens(_Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("model", c_int32),
        ("width_px", c_int32),
        ("height_px", c_int32),
        ("fx_px", c_double),
        ("fy_px", c_double),
        ("cx_px", c_double),
        ("cy_px", c_double),
        ("coefficients", c_double * 14),
    ]


class ViewPrior(_Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("present", c_uint32),
        ("position_in_ecef_m", c_double * 3),
        ("position_covariance_enu_m2", c_double * 9),
        ("up_in_camera", c_double * 3),
        ("up_sigma_deg", c_double),
        ("heading_deg", c_double),
        ("heading_sigma_deg", c_double),
        ("camera_from_enu", c_double * 4),
        ("search_radius_px", c_double),
        ("farthest_m", c_double),
    ]


class ResectOptions(_Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("present", c_uint32),
        ("inlier_threshold_px", c_double),
        ("seed", c_uint64),
        ("most_samples", c_int32),
        ("reserved", c_int32),
        ("intrinsics_covariance", c_double * (18 * 18)),
    ]


class Pose(_Sized):
    _fields_ = [
        ("struct_size", c_uint32),
        ("verdict", c_int32),
        ("inliers", c_int32),
        ("samples", c_int32),
        ("ecef_m", c_double * 3),
        ("latitude_deg", c_double),
        ("longitude_deg", c_double),
        ("height_m", c_double),
        ("camera_from_enu", c_double * 4),
        ("heading_deg", c_double),
        ("pitch_deg", c_double),
        ("roll_deg", c_double),
        ("covariance", c_double * 36),
        ("accuracy_m", c_double),
        ("vertical_accuracy_m", c_double),
        ("noise_px", c_double),
        ("log10_chance", c_double),
        ("alternative_ecef_m", c_double * 3),
        ("alternative_camera_from_enu", c_double * 4),
    ]


def _pointer(array):
    return array.ctypes.data_as(c_void_p)


class Lodemark:
    def __init__(self, build):
        self._library = ctypes.CDLL(str(build / "lib" / "liblodemark.so.1"))
        self._library.lodemark_last_error.restype = c_char_p

    def _check(self, status, *good):
        if status not in (GOOD, *good):
            raise RuntimeError(self._library.lodemark_last_error().decode())

    def unproject(self, lens, pixels, directions, valid):
        """Of n x 2 pixels the n x 3 directions, into arrays of the caller."""
        self._check(
            self._library.lodemark_lens_unproject(
                byref(lens), _pointer(pixels), len(pixels), _pointer(directions), _pointer(valid)
            )
        )

    def project(self, lens, points):
        pixels, valid = np.zeros((len(points), 2)), np.zeros(len(points), np.uint8)
        self._check(
            self._library.lodemark_lens_project(
                byref(lens), _pointer(points), len(points), _pointer(pixels), _pointer(valid)
            )
        )
        pixels[valid == 0] = np.nan
        return pixels

    def resect(self, lens, sights, prior, options):
        """sights: an array of SIGHT. None where there is no pose to use."""
        pose = Pose()
        status = self._library.lodemark_pose_resect(
            byref(lens),
            _pointer(sights),
            len(sights),
            byref(prior) if prior else None,
            byref(options),
            byref(pose),
            *(None, None),
        )
        self._check(status, NO_POSITION)
        return pose if status == GOOD else None

    def ecef_from_geodetic(self, geodetic):
        ecef_m = (c_double * 3)()
        self._check(self._library.lodemark_ecef_from_geodetic((c_double * 3)(*geodetic), ecef_m))
        return np.array(ecef_m)

    def open_map(self, path):
        """A handle for locate; it stays open."""
        handle = c_void_p()
        self._check(self._library.lodemark_map_open(str(path).encode(), byref(handle)))
        return handle

    def query(self, handle, lens, grey):
        """The sights of a photograph, rows of bytes: an array of SIGHT."""
        sights, count = np.zeros(LARGEST_COUNT, SIGHT), c_int32()
        sights["struct_size"] = SIGHT.itemsize
        status = self._library.lodemark_map_query(
            handle,
            byref(lens),
            _pointer(grey),
            c_int64(grey.strides[0]),
            *(None, None),
            _pointer(sights),
            c_int32(LARGEST_COUNT),
            byref(count),
        )
        self._check(status)
        return sights[: count.value]

    def locate(self, handle, lens, grey):
        """The pose of a photograph, rows of bytes; None if it is not of this map."""
        pose, count = Pose(), c_int32()
        status = self._library.lodemark_map_locate(
            handle,
            byref(lens),
            _pointer(grey),
            c_int64(grey.strides[0]),
            *(None, None, None),
            byref(pose),
            *(None, None, c_int32(0), byref(count)),
        )
        self._check(status, NO_POSITION)
        return pose if status == GOOD else None
