# SPDX-License-Identifier: Apache-2.0
# One target for each room and half.
include(GoogleTest)

option(STEADYREST_BENCH "Build the benchmarks in bench/" OFF)
option(STEADYREST_PAGE_TESTS "Test the report in a browser and the snippets of README.md" OFF)
set(STEADYREST_PROPERTY_SEED 1 CACHE STRING "Seed of the property tests: the same cases on every run")
set(STEADYREST_PROPERTY_RUNS 100 CACHE STRING "Cases of each property test; turn it up with another seed to hunt")
set(STEADYREST_SANITIZE "" CACHE STRING "Value of -fsanitize=, empty for none")

add_library(steadyrest_flags INTERFACE)
target_include_directories(steadyrest_flags INTERFACE ${CMAKE_CURRENT_SOURCE_DIR})
target_compile_options(steadyrest_flags INTERFACE
  $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wconversion -Wshadow -Werror>)
# g++ 12 sees overlaps in `"text" + std::string` that are not there (GCC bug 105651).
target_compile_options(steadyrest_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
# clang sees that libstdc++ 12 uses its own deprecated get_temporary_buffer (in std::stable_sort).
target_compile_options(steadyrest_flags INTERFACE $<$<COMPILE_LANG_AND_ID:CXX,Clang>:-Wno-deprecated-declarations>)
# A simulation must give the same bytes on every machine: no fused multiply-add by the compiler's choice.
target_compile_options(steadyrest_flags INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off>)
# Where several sources are compiled as one (release and the sanitizers: half the time), g++ takes a type private to a
# source for one from a header.
if(CMAKE_UNITY_BUILD)
  target_compile_options(steadyrest_flags INTERFACE $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-subobject-linkage>)
endif()
if(STEADYREST_SANITIZE)
  target_compile_options(steadyrest_flags INTERFACE
    $<$<COMPILE_LANGUAGE:CXX>:-fsanitize=${STEADYREST_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer>
    $<$<COMPILE_LANG_AND_ID:CXX,Clang>:-fsanitize-ignorelist=${CMAKE_SOURCE_DIR}/cmake/ubsan-ignorelist.txt>)
  target_link_options(steadyrest_flags INTERFACE -fsanitize=${STEADYREST_SANITIZE})
endif()

# Code that reads options and writes text takes long to compile and no time to run: it is optimised little, in sanitized
# builds not at all.
if(STEADYREST_SANITIZE)
  set(steadyrest_not_hot_options $<$<COMPILE_LANGUAGE:CXX>:-O0>)
else()
  set(steadyrest_not_hot_options $<$<AND:$<COMPILE_LANGUAGE:CXX>,$<CONFIG:Release>>:-O1>)
endif()
function(steadyrest_not_hot target)
  target_compile_options(${target} PRIVATE ${steadyrest_not_hot_options})
endfunction()

# Code that runs for each of a program's million lines. It is position-independent, so g++ calls its own functions
# through the linker's table and does not inline them unless told that nobody replaces them, which clang assumes anyway.
# The results are the same to the last bit.
function(steadyrest_hot target)
  target_compile_options(${target} PRIVATE
    $<$<AND:$<COMPILE_LANG_AND_ID:CXX,GNU>,$<CONFIG:Release>>:-O3;-fno-semantic-interposition;-fno-math-errno>)
  # A move is 384 bytes: `rep movs`, which g++ uses for that, costs more than plain copying.
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    set(way vector_loop:1024:noalign,libcall:-1:noalign)
    target_compile_options(${target} PRIVATE
      $<$<AND:$<COMPILE_LANG_AND_ID:CXX,GNU>,$<CONFIG:Release>>:-mmemcpy-strategy=${way};-mmemset-strategy=${way}>)
  endif()
endfunction()

# steadyrest_room(NAME kernel SOURCES a.cpp … DEPENDS steadyrest_math … TESTS test/a_test.cpp … TEST_DEPENDS …)
# makes the library steadyrest_<NAME> and, where TESTS are named, the executable steadyrest_<NAME>_test. TESTS_COMPUTE: see
# COMPUTES of steadyrest_test.
function(steadyrest_room)
  cmake_parse_arguments(ROOM "TESTS_COMPUTE" "NAME" "SOURCES;DEPENDS;TESTS;TEST_DEPENDS" ${ARGN})
  set(target steadyrest_${ROOM_NAME})
  if(ROOM_SOURCES)
    add_library(${target} STATIC ${ROOM_SOURCES})
    target_link_libraries(${target} PUBLIC steadyrest_flags ${ROOM_DEPENDS})
  else()
    add_library(${target} INTERFACE)
    target_link_libraries(${target} INTERFACE steadyrest_flags ${ROOM_DEPENDS})
  endif()
  if(ROOM_TESTS)
    set(computes "")
    if(ROOM_TESTS_COMPUTE)
      set(computes COMPUTES)
    endif()
    steadyrest_test(NAME ${ROOM_NAME} ${computes} SOURCES ${ROOM_TESTS} DEPENDS ${target} ${ROOM_TEST_DEPENDS})
  endif()
endfunction()

# From a precompiled header g++ 12 warns about its own library: it takes code inlined from there for ours (compare GCC bug
# 105651). clang and AddressSanitizer check the bounds.
set(steadyrest_pch_false_positives -Wno-array-bounds -Wno-stringop-overflow)

# Headers parsed once for all that share them, where they take longer than the code: the test frameworks, and code that
# reads options and writes JSON. Code optimised differently needs its own copy. It is an executable, since it must be
# compiled like its users.
# steadyrest_headers(target HEADERS <a> … DEPENDS … OPTIONS …)
function(steadyrest_headers target)
  cmake_parse_arguments(H "" "" "HEADERS;DEPENDS;OPTIONS" ${ARGN})
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/${target}.cpp CONTENT "int main() {}\n")
  add_executable(${target} ${CMAKE_BINARY_DIR}/${target}.cpp)
  target_link_libraries(${target} PRIVATE steadyrest_flags ${H_DEPENDS})
  target_compile_options(${target} PRIVATE ${H_OPTIONS} $<$<CXX_COMPILER_ID:Clang>:-Xclang;-fno-pch-timestamp>)
  target_precompile_headers(${target} PRIVATE ${H_HEADERS})
endfunction()
# In sanitized builds compiling the tests took longer than running them: there they are not optimised, except those that
# compute much themselves. The linker takes a template's function from the test where it has one.
if(STEADYREST_SANITIZE)
  set(steadyrest_test_options ${steadyrest_not_hot_options})
endif()
set(test_frameworks steadyrest_rapidcheck GTest::gtest GTest::gmock GTest::gtest_main)
set(test_headers <gmock/gmock.h> <gtest/gtest.h> <rapidcheck.h>)
set(text_headers <fmt/format.h> <nlohmann/json.hpp>)
steadyrest_headers(steadyrest_test_headers HEADERS ${test_headers} DEPENDS ${test_frameworks}
  OPTIONS ${steadyrest_test_options})
if(STEADYREST_SANITIZE)
  steadyrest_headers(steadyrest_test_headers_computing HEADERS ${test_headers} DEPENDS ${test_frameworks})
endif()
steadyrest_headers(steadyrest_test_headers_not_hot HEADERS ${test_headers} ${text_headers}
  DEPENDS ${test_frameworks} fmt::fmt nlohmann_json::nlohmann_json OPTIONS ${steadyrest_not_hot_options})
steadyrest_headers(steadyrest_program_headers HEADERS <CLI/CLI.hpp> ${text_headers}
  DEPENDS CLI11::CLI11 fmt::fmt nlohmann_json::nlohmann_json OPTIONS ${steadyrest_not_hot_options})

# A test on a control or in a browser, which takes its time and leaves the processor much of it: one of them at a time beside
# the others, and from the start, so that none is left over at the end.
set(steadyrest_live_test RESOURCE_LOCK live COST 1000)
# A test that takes minutes: early, so that it does not end alone.
set(steadyrest_long_test COST 100)

# All test executables with the label `threads`: those worth building for ThreadSanitizer.
add_custom_target(threads_tests)

# steadyrest_test(NAME x SOURCES … DEPENDS … LABEL fast|slow|threads|… NOT_HOT COMPUTES LIVE ALONE): a GoogleTest executable; every test is a
# ctest entry; with WHOLE all of them are one, so that a suite starts its server once. Several labels may be given. NOT_HOT: see
# steadyrest_not_hot. COMPUTES: optimised in sanitized builds too. LIVE: steadyrest_live_test. ALONE: nothing runs beside it.
function(steadyrest_test)
  cmake_parse_arguments(T "NOT_HOT;COMPUTES;LIVE;ALONE;WHOLE" "NAME" "SOURCES;DEPENDS;LABEL" ${ARGN})
  if(NOT T_LABEL)
    set(T_LABEL fast)
  endif()
  set(target steadyrest_${T_NAME}_test)
  add_executable(${target} ${T_SOURCES})
  target_link_libraries(${target} PRIVATE ${T_DEPENDS} steadyrest_flags steadyrest_rapidcheck
    GTest::gtest GTest::gmock GTest::gtest_main)
  target_compile_definitions(${target} PRIVATE STEADYREST_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
  target_compile_options(${target} PRIVATE "$<$<COMPILE_LANG_AND_ID:CXX,GNU>:${steadyrest_pch_false_positives}>")
  if(T_NOT_HOT)
    steadyrest_not_hot(${target})
    target_link_libraries(${target} PRIVATE fmt::fmt nlohmann_json::nlohmann_json)
    target_precompile_headers(${target} REUSE_FROM steadyrest_test_headers_not_hot)
  elseif(T_COMPUTES AND STEADYREST_SANITIZE)
    target_precompile_headers(${target} REUSE_FROM steadyrest_test_headers_computing)
  else()
    target_compile_options(${target} PRIVATE ${steadyrest_test_options})
    target_precompile_headers(${target} REUSE_FROM steadyrest_test_headers)
  endif()
  if("threads" IN_LIST T_LABEL)
    add_dependencies(threads_tests ${target})
  endif()
  set(properties LABELS "${T_LABEL}" TIMEOUT 600
    ENVIRONMENT "RC_PARAMS=seed=${STEADYREST_PROPERTY_SEED} max_success=${STEADYREST_PROPERTY_RUNS}")
  if(T_LIVE)
    list(APPEND properties ${steadyrest_live_test})
  elseif(T_ALONE)
    list(APPEND properties RUN_SERIAL TRUE)
  endif()
  if(T_WHOLE)
    add_test(NAME ${T_NAME} COMMAND ${target})
    set_tests_properties(${T_NAME} PROPERTIES ${properties})
  else()
    gtest_discover_tests(${target} DISCOVERY_TIMEOUT 60 PROPERTIES ${properties})
  endif()
endfunction()

# steadyrest_bench(NAME x SOURCES … DEPENDS …): an executable of Google Benchmark; the target `bench` runs all of them.
if(STEADYREST_BENCH)
  find_package(benchmark REQUIRED)
  add_custom_target(bench)
endif()
function(steadyrest_bench)
  cmake_parse_arguments(B "" "NAME" "SOURCES;DEPENDS" ${ARGN})
  set(target steadyrest_${B_NAME}_bench)
  add_executable(${target} ${B_SOURCES})
  target_link_libraries(${target} PRIVATE ${B_DEPENDS} steadyrest_flags benchmark::benchmark_main)
  target_compile_definitions(${target} PRIVATE STEADYREST_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
  add_custom_target(run_${target} COMMAND ${target} USES_TERMINAL WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
  add_dependencies(bench run_${target})
endfunction()
