"""Makes the wheel: CMake compiles and installs the module, setuptools packs what CMake installed.

    pip wheel library/python                            compiles the library
    CSCD_BUILD=build-release pip wheel library/python   takes the module from a build folder of CMake, which is named as seen
                                                        from where pip is called

Work is done in a folder for temporary files, and nothing is written into the sources.

Compiling needs Debian's cmake, g++, libeigen3-dev, libboost-dev, pybind11-dev and python3-dev. The wheel takes no oneTBB, so it needs
nothing of a system but Python, numpy and the C++ runtime, and answers on the calling thread. A wheel from a build folder needs what that
build links.
"""
import atexit
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from setuptools import Distribution, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parents[2]
WORK = pathlib.Path(tempfile.mkdtemp(prefix="cscd-wheel-"))
atexit.register(shutil.rmtree, WORK, ignore_errors=True)


def given_build():
    """The build folder that CSCD_BUILD names, or None.

    pip runs this file in the folder of the sources, so a relative name is one that the process which started this one sees.
    """
    name = os.environ.get("CSCD_BUILD")
    if not name:
        return None
    try:
        caller = pathlib.Path(f"/proc/{os.getppid()}/cwd").resolve(strict=True)
    except OSError:
        caller = pathlib.Path(os.environ.get("PWD", "."))
    build = caller / name
    if not any(build.glob("python/cscd/_cscd*.so")):
        sys.exit(f"CSCD_BUILD={name}: no Python module in {build}/python; "
                 f"make it by cmake --build {name} --target cscd_python, or leave CSCD_BUILD unset")
    return build


GIVEN = given_build()


class Compiled(Distribution):
    def has_ext_modules(self):
        return True  # the wheel is for one Python and one machine


class ByCMake(build_ext):
    def run(self):
        build = GIVEN or WORK / "cmake"
        if not GIVEN:
            subprocess.run(["cmake", "-S", ROOT, "-B", build, "-DCSCD_LIBRARY_ONLY=ON", "-DCMAKE_BUILD_TYPE=Release",
                            "-DCMAKE_DISABLE_FIND_PACKAGE_TBB=ON",
                            f"-DPYTHON_EXECUTABLE={sys.executable}"], check=True)
            subprocess.run(["cmake", "--build", build, "--target", "cscd_python", "--parallel", str(os.cpu_count())], check=True)
        subprocess.run(["cmake", f"-DCMAKE_INSTALL_PREFIX={pathlib.Path(self.build_lib).resolve()}",
                        "-DCMAKE_INSTALL_COMPONENT=python", "-DCSCD_PYTHON_FOLDER=.", "-P", build / "cmake_install.cmake"],
                       check=True)


setup(version=re.search(r"project\(cscd VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())[1],
      distclass=Compiled, cmdclass={"build_ext": ByCMake},
      options={"build": {"build_base": str(WORK / "packed")}, "egg_info": {"egg_base": str(WORK)}})
