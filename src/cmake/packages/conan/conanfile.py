# A Conan 2 recipe that builds the sources it lies in:
#   conan create gpgp/src/cmake/packages/conan --build=missing
import os

from conan import ConanFile
from conan.errors import ConanInvalidConfiguration
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.env import VirtualBuildEnv
from conan.tools.files import copy, load, rmdir
from conan.tools.gnu import PkgConfigDeps


class GpgpConan(ConanFile):
    name = "gpgp"
    description = "Geometry processing middleware for Vulkan game engines"
    topics = ("vulkan", "procedural", "vector-graphics", "visibility", "gpu")
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"shared": [True, False], "fPIC": [True, False], "with_compiler": [True, False], "with_text": [True, False]}
    default_options = {"shared": False, "fPIC": True, "with_compiler": True, "with_text": True}

    @property
    def _root(self):
        return os.path.abspath(os.path.join(self.recipe_folder, "..", "..", "..", ".."))

    def set_version(self):
        header = load(self, os.path.join(self._root, "include", "gpgp", "core.h"))
        numbers = [line.split()[2] for line in header.splitlines()
                   if line.startswith(("#define GPGP_VERSION_MAJOR", "#define GPGP_VERSION_MINOR",
                                       "#define GPGP_VERSION_PATCH"))]
        self.version = ".".join(numbers)

    def export_sources(self):
        for pattern in ("CMakeLists.txt", "LICENSE", "include/*", "shaders/*", "src/*"):
            copy(self, pattern, self._root, self.export_sources_folder)

    def config_options(self):
        if self.settings.os == "Windows":
            del self.options.fPIC

    def configure(self):
        if self.options.shared:
            self.options.rm_safe("fPIC")

    def layout(self):
        cmake_layout(self)

    def requirements(self):
        self.requires("vulkan-headers/1.3.239.0", transitive_headers=True)
        self.requires("glm/cci.20230113")
        self.requires("zstd/1.5.5")
        if self.options.with_compiler:
            self.requires("glslang/1.3.239.0")
            self.requires("spirv-tools/1.3.239.0")
            self.requires("pugixml/1.13")
            self.requires("zlib/[>=1.2.11 <2]")
            self.requires("nlohmann_json/3.11.2")
        if self.options.with_text:
            self.requires("freetype/2.13.0")
            self.requires("harfbuzz/8.0.1")
            self.requires("fribidi/1.0.12")
            self.requires("icu/73.2")

    def build_requirements(self):  # programs: glslangValidator, spirv-val, zstd
        self.tool_requires("cmake/[>=3.25]")
        self.tool_requires("glslang/1.3.239.0")
        self.tool_requires("spirv-tools/1.3.239.0")
        self.tool_requires("zstd/1.5.5")
        self.tool_requires("pkgconf/2.0.3")

    def validate(self):
        check_min_cppstd(self, 20)
        if self.settings.os not in ("Linux", "Windows"):
            raise ConanInvalidConfiguration("gpgp is built for Linux and Windows")

    def generate(self):
        VirtualBuildEnv(self).generate()
        toolchain = CMakeToolchain(self)
        toolchain.variables["GPGP_BUILD_SHARED"] = bool(self.options.shared)
        toolchain.variables["GPGP_BUILD_STATIC"] = not self.options.shared
        toolchain.variables["GPGP_WITH_COMPILER"] = bool(self.options.with_compiler)
        toolchain.variables["GPGP_WITH_TEXT"] = bool(self.options.with_text)
        toolchain.variables["GPGP_INSTALL"] = True
        toolchain.variables["GPGP_WERROR"] = False
        for part in ("CLI", "SAMPLES", "INTEGRATIONS", "TESTS"):
            toolchain.variables["GPGP_BUILD_" + part] = False
        toolchain.generate()
        CMakeDeps(self).generate()
        PkgConfigDeps(self).generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))
        rmdir(self, os.path.join(self.package_folder, "share"))

    def package_info(self):  # the installed gpgpConfig.cmake is used as it is
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs.append(os.path.join("lib", "cmake", "gpgp"))
