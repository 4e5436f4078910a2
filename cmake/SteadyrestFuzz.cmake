# SPDX-License-Identifier: Apache-2.0
option(STEADYREST_FUZZ "Build the libFuzzer targets (clang)" OFF)
if(STEADYREST_FUZZ)
  target_compile_options(steadyrest_flags INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-fsanitize=fuzzer-no-link>)
endif()

# steadyrest_fuzz(NAME x SOURCES x_fuzz.cpp DEPENDS … CORPUS folder …): with STEADYREST_FUZZ the libFuzzer program
# steadyrest_x_fuzz. Without it the same entry point is built with a main that runs the CORPUS folders through it once, as a
# ctest entry, so that a fuzz target cannot rot.
#   cmake --preset fuzz && cmake --build --preset fuzz --target steadyrest_x_fuzz
#   build/fuzz/bin/steadyrest_x_fuzz -max_total_time=60 NEW_CORPUS_FOLDER SEED_FOLDER …
function(steadyrest_fuzz)
  cmake_parse_arguments(F "" "NAME" "SOURCES;DEPENDS;CORPUS" ${ARGN})
  set(target steadyrest_${F_NAME}_fuzz)
  add_executable(${target} ${F_SOURCES})
  target_link_libraries(${target} PRIVATE ${F_DEPENDS} steadyrest_flags)
  if(STEADYREST_FUZZ)
    target_link_options(${target} PRIVATE -fsanitize=fuzzer)
  else()
    target_sources(${target} PRIVATE ${CMAKE_SOURCE_DIR}/tests/fuzz/replay.cpp)
    # It tests whether the target has a mutator, which it cannot do in one unit with the definition.
    set_source_files_properties(${CMAKE_SOURCE_DIR}/tests/fuzz/replay.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    add_test(NAME Fuzz.${F_NAME} COMMAND ${target} ${F_CORPUS} WORKING_DIRECTORY ${CMAKE_SOURCE_DIR})
    set_tests_properties(Fuzz.${F_NAME} PROPERTIES LABELS fast TIMEOUT 300)
  endif()
endfunction()
