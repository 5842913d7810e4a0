# SPDX-License-Identifier: MIT
# What is installed, and the Debian packages that `cpack` makes of it: the shared library, all that it takes to build
# with it (libtalus-dev), and the program.

# Debian has libraries below lib/<architecture>, and its linker, pkg-config and CMake look there, also in /usr/local.
if(NOT DEFINED CMAKE_INSTALL_LIBDIR AND EXISTS /etc/debian_version AND CMAKE_LIBRARY_ARCHITECTURE)
    set(CMAKE_INSTALL_LIBDIR lib/${CMAKE_LIBRARY_ARCHITECTURE} CACHE PATH "Object code libraries, below the prefix")
endif()
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(talus_cmake_folder ${CMAKE_INSTALL_LIBDIR}/cmake/talus)

# ---- libraries and headers ----
install(TARGETS talus_shared EXPORT talus_shared
    LIBRARY COMPONENT library NAMELINK_COMPONENT development)
install(TARGETS talus_static EXPORT talus_static ARCHIVE COMPONENT development)
install(DIRECTORY include/talus DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)

# ---- for find_package and pkg-config ----
foreach(kind IN ITEMS shared static)
    install(EXPORT talus_${kind} FILE talus-${kind}.cmake NAMESPACE talus:: DESTINATION ${talus_cmake_folder}
        COMPONENT development)
endforeach()
configure_package_config_file(cmake/talusConfig.cmake.in talusConfig.cmake INSTALL_DESTINATION ${talus_cmake_folder}
    NO_SET_AND_CHECK_MACRO)
# Until 1.0.0 each minor version may change the interface.
write_basic_package_version_file(talusConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/talusConfig.cmake ${PROJECT_BINARY_DIR}/talusConfigVersion.cmake
    DESTINATION ${talus_cmake_folder} COMPONENT development)
file(RELATIVE_PATH talus_prefix_from_pc /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
configure_file(cmake/talus.pc.in talus.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/talus.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)

# ---- the program ----
if(TALUS_PROGRAM)
    install(TARGETS talus_program RUNTIME COMPONENT program)
endif()

# ---- Debian packages ----
if(NOT PROJECT_IS_TOP_LEVEL)
    return()
endif()
set(talus_soname ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The authors of Talus <talus@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_COMPONENTS_ALL library development)
if(TALUS_PROGRAM)
    list(APPEND CPACK_COMPONENTS_ALL program)
endif()

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libtalus${talus_soname})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_DESCRIPTION "${PROJECT_DESCRIPTION}\nThe shared library.")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_GENERATE_SHLIBS ON)
# The OpenGL driver is loaded when a world wants a GPU; without one worlds run on the CPU.
set(CPACK_DEBIAN_LIBRARY_PACKAGE_RECOMMENDS "libegl1, libgl1-mesa-dri")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libtalus-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION
    "${PROJECT_DESCRIPTION}\nHeaders, the static library, and what CMake and pkg-config look for.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "libtalus${talus_soname} (= ${PROJECT_VERSION}), libegl-dev, libepoxy-dev, libtbb-dev, libzstd-dev")

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME talus)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION
    "${PROJECT_DESCRIPTION}\nThe program talus: scenes, measurements, pictures and videos.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "ffmpeg, libegl1, libgl1-mesa-dri")
include(CPack)
