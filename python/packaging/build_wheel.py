# SPDX-License-Identifier: BSD-3-Clause
"""Builds the wheel of the package ergocast with CMake, for `pip install ./python`.

pip calls build_wheel() of this file (PEP 517). It needs no other Python package, so pip downloads nothing
to build. It needs the Debian packages of packaging/packages.txt, pybind11-dev and Python's headers.
"""

import base64
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
TAG = "cp{0}{1}-cp{0}{1}-{2}".format(*sys.version_info[:2], re.sub(r"\W", "_", sysconfig.get_platform()))
TIME = (1980, 1, 1, 0, 0, 0)  # the earliest of a zip file


def version():
    return re.search(r"project\(ergocast VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]


def metadata():
    return (f"Metadata-Version: 2.1\nName: ergocast\nVersion: {version()}\n"
            "Summary: Ergodic coverage: records, simulations, the method\nLicense: BSD-3-Clause\n"
            "Requires-Python: >=3.11\nRequires-Dist: numpy\nRequires-Dist: pandas\n"
            "Provides-Extra: plot\nRequires-Dist: matplotlib; extra == 'plot'\n")


def run(*command):
    """Runs a command; its output goes to stderr, which pip shows with -v or after a failure."""
    subprocess.run(command, check=True, stdout=sys.stderr)


def was_moved(folder):
    """Whether CMake configured the folder for a checkout at another path, which CMake refuses to take over."""
    cache = folder / "CMakeCache.txt"
    return cache.exists() and f"\nCMAKE_HOME_DIRECTORY:INTERNAL={ROOT}\n" not in cache.read_text()


def built_package():
    """The folder of the package, with its compiled module for this Python."""
    for tool in ("cmake", "ninja"):
        if shutil.which(tool) is None:
            raise SystemExit(f"{tool} is missing: install the packages of packaging/packages.txt")
    folder = ROOT / "build" / f"wheel-{TAG}"
    arguments = os.environ.get("ERGOCAST_CMAKE_ARGS", "").split()
    if was_moved(folder):
        arguments.append("--fresh")
    run("cmake", "-S", ROOT, "--preset", "release", "-B", folder, "-DBUILD_TESTING=OFF",
        f"-DPython_EXECUTABLE={sys.executable}", *arguments)
    targets = subprocess.run(["ninja", "-C", folder, "-t", "targets", "all"], check=True, capture_output=True, text=True)
    if "ergocast_python:" not in targets.stdout:
        raise SystemExit("no Python headers or no pybind11: apt install python3-dev pybind11-dev")
    run("cmake", "--build", folder, "--target", "ergocast_python")
    return folder / "python" / "ergocast"


def wheel_text():
    return f"Wheel-Version: 1.0\nGenerator: ergocast\nRoot-Is-Purelib: false\nTag: {TAG}\n"


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    info = pathlib.Path(metadata_directory) / f"ergocast-{version()}.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(metadata())
    (info / "WHEEL").write_text(wheel_text())
    return info.name


def get_requires_for_build_wheel(config_settings=None):
    return []


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    info = f"ergocast-{version()}.dist-info"
    package = built_package()
    files = {f"ergocast/{path.relative_to(package)}": path.read_bytes()
             for path in sorted(package.rglob("*")) if path.is_file() and "__pycache__" not in path.parts}
    # pip puts them below the environment's share, where the package finds them by name.
    shipped = f"ergocast-{version()}.data/data/share/ergocast/scenarios"
    folder = ROOT / "scenarios"
    files |= {f"{shipped}/{path.relative_to(folder)}": path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}
    files[f"{info}/METADATA"] = metadata().encode()
    files[f"{info}/WHEEL"] = wheel_text().encode()
    files[f"{info}/licenses/LICENSE"] = (ROOT / "LICENSE").read_bytes()

    record = ""
    for name, data in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        record += f"{name},sha256={digest},{len(data)}\n"
    files[f"{info}/RECORD"] = (record + f"{info}/RECORD,,\n").encode()

    wheel = f"ergocast-{version()}-{TAG}.whl"
    with zipfile.ZipFile(pathlib.Path(wheel_directory) / wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            entry = zipfile.ZipInfo(name, TIME)
            entry.external_attr = (0o755 if name.endswith(".so") else 0o644) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, data)
    return wheel


def build_sdist(sdist_directory, config_settings=None):
    raise SystemExit("the sources are in the whole tree: use the archive of packaging/release")
