# SPDX-License-Identifier: Apache-2.0
# Every library is Debian's own package; docs/dependencies.md says what each is for.
find_package(fmt REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(Boost REQUIRED)  # headers only
find_package(GTest REQUIRED)
find_package(TBB REQUIRED CONFIG)
find_package(Threads REQUIRED)
find_package(OpenSSL REQUIRED)
find_package(ZLIB REQUIRED)
find_package(SQLite3 REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(tomlplusplus REQUIRED IMPORTED_TARGET tomlplusplus)
pkg_check_modules(hdf5 IMPORTED_TARGET hdf5)  # optional
pkg_check_modules(libsodium REQUIRED IMPORTED_TARGET libsodium)
find_path(RAPIDCHECK_INCLUDE_DIR rapidcheck.h REQUIRED)
find_library(RAPIDCHECK_LIBRARY rapidcheck REQUIRED)
add_library(steadyrest_rapidcheck INTERFACE)
target_include_directories(steadyrest_rapidcheck SYSTEM INTERFACE ${RAPIDCHECK_INCLUDE_DIR})
target_link_libraries(steadyrest_rapidcheck INTERFACE ${RAPIDCHECK_LIBRARY})
