"""Conan's recipe of the checkout that this file lies in: conan create scripts/packages/conan --build=missing"""
import os
import re

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, load, rm


class Cscd(ConanFile):
    name = "cscd"
    license = "MIT"
    description = "Continuous self-collision detection of deforming triangle meshes"
    package_type = "library"
    settings = "os", "compiler", "build_type", "arch"
    options = {"shared": [True, False], "threads": [True, False]}
    default_options = {"shared": False, "threads": True, "boost/*:header_only": True}

    def root(self):
        return os.path.join(self.recipe_folder, "..", "..", "..")

    def set_version(self):
        self.version = re.search(r"project\(cscd VERSION ([0-9.]+)", load(self, os.path.join(self.root(), "CMakeLists.txt")))[1]

    def export_sources(self):
        for pattern in ("CMakeLists.txt", "LICENSE", "core/*", "library/*", "scripts/cmake/*"):
            copy(self, pattern, src=self.root(), dst=self.export_sources_folder)

    def requirements(self):
        self.requires("eigen/3.4.0", transitive_headers=True)
        self.requires("boost/1.83.0")
        if self.options.threads:
            self.requires("onetbb/2021.12.0")

    def layout(self):
        cmake_layout(self)

    def generate(self):
        toolchain = CMakeToolchain(self)
        toolchain.cache_variables["CSCD_LIBRARY_ONLY"] = True
        toolchain.cache_variables["CMAKE_DISABLE_FIND_PACKAGE_TBB"] = not self.options.threads
        toolchain.cache_variables["CMAKE_DISABLE_FIND_PACKAGE_pybind11"] = True
        toolchain.generate()
        CMakeDeps(self).generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()
        # Both are built; a package holds one of them.
        for name in ("libcscd.a",) if self.options.shared else ("libcscd.so*", "libcscd.dylib", "libcscd*.dll*"):
            rm(self, name, self.package_folder, recursive=True)

    def package_info(self):
        self.cpp_info.libs = ["cscd"]
