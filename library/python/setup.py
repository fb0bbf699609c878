"""Makes the wheel: CMake compiles and installs the module, setuptools packs what CMake installed.

    pip wheel library/python                            compiles the library in build-wheel/cmake, below the repository
    CSCD_BUILD=build-release pip wheel library/python   takes the module from a build folder of CMake

Compiling needs Debian's cmake, g++, libeigen3-dev, libtbb-dev, libgmp-dev, pybind11-dev and python3-dev. The wheel uses the
libraries oneTBB and GMP of the machine, so it is for systems like the one that made it.
"""
import os
import pathlib
import re
import subprocess
import sys

from setuptools import Distribution, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parents[2]
GIVEN = os.environ.get("CSCD_BUILD")
WORK = pathlib.Path(GIVEN).resolve() / "wheel" if GIVEN else ROOT / "build-wheel"


class Compiled(Distribution):
    def has_ext_modules(self):
        return True  # the wheel is for one Python and one machine


class ByCMake(build_ext):
    def run(self):
        build = WORK.parent if GIVEN else WORK / "cmake"
        if not GIVEN:
            subprocess.run(["cmake", "-S", ROOT, "-B", build, "-DCSCD_LIBRARY_ONLY=ON", "-DCMAKE_BUILD_TYPE=Release",
                            f"-DPYTHON_EXECUTABLE={sys.executable}"], check=True)
            subprocess.run(["cmake", "--build", build, "--target", "cscd_python", "--parallel", str(os.cpu_count())], check=True)
        subprocess.run(["cmake", f"-DCMAKE_INSTALL_PREFIX={pathlib.Path(self.build_lib).resolve()}",
                        "-DCMAKE_INSTALL_COMPONENT=python", "-DCSCD_PYTHON_FOLDER=.", "-P", build / "cmake_install.cmake"],
                       check=True)


WORK.mkdir(parents=True, exist_ok=True)
setup(version=re.search(r"project\(cscd VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())[1],
      distclass=Compiled, cmdclass={"build_ext": ByCMake},
      # Nothing is written into the sources.
      options={"build": {"build_base": str(WORK / "packed")}, "egg_info": {"egg_base": str(WORK)}})
