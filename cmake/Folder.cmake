# flexura_folder(NAME [THREADS] [LIGHT] [BUSY_TESTS] [LIGHT_TESTS] [SHARDS n] [LINKS targets...] [PRIVATE_LINKS targets...])
#
# Creates the library flexura::NAME from the current folder: every *.cc and *.h in it and in its subfolders, except
#   *_test.cc       quick tests    -> executable NAME_test,       ctest NAME,      label quick
#   *_full_test.cc  longer tests   -> executable NAME_full_test,  ctest NAME.full, label full
#   *_fuzz.cc       fuzz targets   -> executable each (see flexura_fuzz_target)
# THREADS: its code or its tests start threads. Only these tests run with ThreadSanitizer.
# LIGHT: its code does little arithmetic. It is compiled with -O1 and its tests with -O0, which is faster than -O3. Not
# for folders that instantiate Eigen kernels: the linker may use these for the whole program.
# BUSY_TESTS: its tests compute much themselves (for example, render boards) and are compiled with -O1.
# LIGHT_TESTS: its tests compute little themselves and are compiled with -O0, although the code is not LIGHT.
# SHARDS: each test executable is split into n ctests, NAME.1 and so on, so that one folder does not delay the rest.
# LINKS: the folders that may be included. This enforces the architecture.
function(flexura_folder name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "THREADS;LIGHT;BUSY_TESTS;LIGHT_TESTS" "SHARDS" "LINKS;PRIVATE_LINKS")
  file(GLOB sources CONFIGURE_DEPENDS *.cc *.h */*.cc */*.h)
  set(tests ${sources})
  set(fuzzers ${sources})
  list(FILTER sources EXCLUDE REGEX "(_test|_fuzz|/main)[.]cc$")
  list(FILTER tests INCLUDE REGEX "_test[.]cc$")
  list(FILTER fuzzers INCLUDE REGEX "_fuzz[.]cc$")

  add_library(flexura_${name} STATIC ${sources})
  add_library(flexura::${name} ALIAS flexura_${name})
  set_target_properties(flexura_${name} PROPERTIES EXPORT_NAME ${name} LINKER_LANGUAGE CXX)
  target_compile_options(flexura_${name} PRIVATE ${FLEXURA_LIBRARY_OPTIONS})
  target_include_directories(flexura_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(flexura_${name} PUBLIC ${arg_LINKS}
    PRIVATE ${arg_PRIVATE_LINKS} $<BUILD_INTERFACE:flexura_settings>)
  target_compile_features(flexura_${name} PUBLIC cxx_std_20)
  if(arg_LIGHT)
    target_compile_options(flexura_${name} PRIVATE ${FLEXURA_LIGHT_OPTIONS})
    flexura_use_pch(flexura_${name} flexura_light_pch OPTIONS ${FLEXURA_LIBRARY_OPTIONS} ${FLEXURA_LIGHT_OPTIONS}
      HEADERS ${FLEXURA_PCH_HEADERS})
  else()
    flexura_use_pch(flexura_${name} flexura_pch OPTIONS ${FLEXURA_LIBRARY_OPTIONS} HEADERS ${FLEXURA_PCH_HEADERS})
  endif()
  set_property(GLOBAL APPEND PROPERTY FLEXURA_FOLDERS ${name})

  set(has_tests ${FLEXURA_TESTS})
  if(FLEXURA_SANITIZE STREQUAL thread AND NOT arg_THREADS)
    set(has_tests OFF)
  endif()
  if(has_tests)
    set(full_tests ${tests})
    list(FILTER tests EXCLUDE REGEX "_full_test[.]cc$")
    list(FILTER full_tests INCLUDE REGEX "_full_test[.]cc$")
    set(light "")
    if(arg_LIGHT_TESTS OR (arg_LIGHT AND NOT arg_BUSY_TESTS))
      set(light LIGHT)
    endif()
    flexura_test(${name}_test ${name} quick ${name} ${tests} SHARDS ${arg_SHARDS} ${light})
    if(FLEXURA_FULL_TESTS)
      flexura_test(${name}_full_test ${name}.full full ${name} ${full_tests} SHARDS ${arg_SHARDS} ${light})
    endif()
  endif()
  # Fuzz targets start no threads, so ThreadSanitizer is not needed.
  if(FLEXURA_SANITIZE STREQUAL thread)
    set(fuzzers "")
  endif()
  foreach(source ${fuzzers})
    cmake_path(GET source STEM stem)
    flexura_fuzz_target(${stem} ${name} ${source})
  endforeach()
endfunction()

# The Python module is a shared library that contains the folders. Hidden symbols keep position-independent code as fast
# as other code.
set(FLEXURA_LIBRARY_OPTIONS -fPIC -fvisibility=hidden -fvisibility-inlines-hidden)
set(FLEXURA_LIGHT_OPTIONS $<$<CONFIG:Release>:-O1>)
# Tests are compiled with less optimisation, which is 20 % faster; the code under test keeps its optimisation.
set(FLEXURA_TEST_OPTIONS $<$<CONFIG:Release>:-O1>)
set(FLEXURA_LIGHT_TEST_OPTIONS $<$<CONFIG:Release>:-O0>)

# flexura_use_pch(TARGET NAME HEADERS headers... [LINKS targets...] [OPTIONS options...])
#
# Makes TARGET use precompiled headers. They are built once under NAME and shared by every TARGET that uses the same
# arguments. Building them pays off from four sources on. GCC compiles sources with the optimisation level of the
# precompiled header, whatever TARGET sets, so OPTIONS must contain the TARGET's -O. The lint preset does not use them,
# which checks that each source includes what it uses.
function(flexura_use_pch target name)
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "" "HEADERS;LINKS;OPTIONS")
  if(NOT FLEXURA_PCH)
    return()
  endif()
  if(NOT TARGET ${name})
    set(source ${PROJECT_BINARY_DIR}/pch/${name}.cc)
    file(CONFIGURE OUTPUT ${source} CONTENT "// Carries the precompiled headers.\n")
    add_library(${name} OBJECT ${source})
    target_link_libraries(${name} PRIVATE flexura_settings Eigen3::Eigen fmt::fmt ${arg_LINKS})
    target_compile_options(${name} PRIVATE ${arg_OPTIONS})
    target_precompile_headers(${name} PRIVATE ${arg_HEADERS})
    if(CCACHE)
      set_target_properties(${name} PROPERTIES
        CXX_COMPILER_LAUNCHER "${PROJECT_SOURCE_DIR}/cmake/compile_pch.sh;${CMAKE_CXX_COMPILER_LAUNCHER}")
    endif()
  endif()
  target_include_directories(${target} SYSTEM PRIVATE
    $<BUILD_INTERFACE:$<TARGET_PROPERTY:Eigen3::Eigen,INTERFACE_INCLUDE_DIRECTORIES>>)
  # GCC rejects precompiled headers that were compiled with other definitions.
  target_compile_definitions(${target} PRIVATE
    $<BUILD_INTERFACE:$<TARGET_PROPERTY:fmt::fmt,INTERFACE_COMPILE_DEFINITIONS>>)
  target_precompile_headers(${target} REUSE_FROM ${name})
endfunction()

set(FLEXURA_PCH_HEADERS
  <Eigen/Dense> <fmt/format.h> <algorithm> <cmath> <filesystem> <functional> <map> <memory> <optional> <string> <variant>
  <vector>)

# flexura_test(EXECUTABLE CTEST_NAME LABEL FOLDER sources... [SHARDS n] [LIGHT])
#
# Adds one test executable for a folder and a size. Does nothing if there are no sources.
function(flexura_test executable ctest_name label folder)
  cmake_parse_arguments(PARSE_ARGV 4 arg "LIGHT" "SHARDS" "")
  if(NOT arg_UNPARSED_ARGUMENTS)
    return()
  endif()
  add_executable(${executable} ${arg_UNPARSED_ARGUMENTS})
  if(NOT TARGET checkout)
    add_library(checkout STATIC ${PROJECT_SOURCE_DIR}/tests/support/checkout.cc)
    target_include_directories(checkout PRIVATE ${PROJECT_SOURCE_DIR})
    target_link_libraries(checkout PRIVATE flexura_settings)
    target_compile_definitions(checkout PRIVATE
      FLEXURA_SOURCE_DIR="${PROJECT_SOURCE_DIR}" FLEXURA_BINARY_DIR="${CMAKE_BINARY_DIR}")
  endif()
  target_link_libraries(${executable} PRIVATE
    flexura::${folder} checkout flexura_settings Eigen3::Eigen GTest::gtest_main GTest::gmock)
  set(options ${FLEXURA_TEST_OPTIONS})
  set(headers flexura_test_pch)
  if(arg_LIGHT)
    set(options ${FLEXURA_LIGHT_TEST_OPTIONS})
    set(headers flexura_light_test_pch)
  endif()
  target_compile_options(${executable} PRIVATE ${options})
  flexura_use_pch(${executable} ${headers} LINKS GTest::gmock OPTIONS ${options}
    HEADERS <gtest/gtest.h> <gmock/gmock.h> ${FLEXURA_PCH_HEADERS})
  set(timeout 600)
  if(FLEXURA_SANITIZE)
    set(timeout 1800)
  endif()
  set(shards 1)
  if(arg_SHARDS)
    set(shards ${arg_SHARDS})
  endif()
  foreach(shard RANGE 1 ${shards})
    set(test ${ctest_name})
    if(shards GREATER 1)
      set(test ${ctest_name}.${shard})
    endif()
    add_test(NAME ${test} COMMAND ${executable})
    math(EXPR index "${shard} - 1")
    # Sharded tests take long, so they start first.
    set_tests_properties(${test} PROPERTIES LABELS ${label} TIMEOUT ${timeout} COST ${shards}
      ENVIRONMENT "GTEST_TOTAL_SHARDS=${shards};GTEST_SHARD_INDEX=${index}")
  endforeach()
endfunction()

# Adds a fuzz target, a source with LLVMFuzzerTestOneInput. With FLEXURA_FUZZ it is a libFuzzer executable. Otherwise it
# is linked with tests/fuzz_driver.cc, which replays the committed corpus (tests/corpus/STEM) and seeded mutations of
# it, and runs as a quick test.
function(flexura_fuzz_target stem folder source)
  if(NOT FLEXURA_FUZZ AND NOT FLEXURA_TESTS)
    return()
  endif()
  if(FLEXURA_FUZZ)
    add_executable(${stem} ${source})
    target_link_libraries(${stem} PRIVATE flexura::${folder} flexura_settings)
    target_link_options(${stem} PRIVATE -fsanitize=fuzzer)
  else()
    if(NOT TARGET fuzz_driver)
      add_library(fuzz_driver STATIC ${PROJECT_SOURCE_DIR}/tests/fuzz_driver.cc)
      target_include_directories(fuzz_driver PRIVATE ${PROJECT_SOURCE_DIR})
      target_link_libraries(fuzz_driver PRIVATE flexura_settings)
    endif()
    add_executable(${stem} ${source})
    target_link_libraries(${stem} PRIVATE fuzz_driver flexura::${folder} flexura_settings)
    target_compile_options(${stem} PRIVATE ${FLEXURA_LIBRARY_OPTIONS} ${FLEXURA_LIGHT_OPTIONS})
    flexura_use_pch(${stem} flexura_light_pch OPTIONS ${FLEXURA_LIBRARY_OPTIONS} ${FLEXURA_LIGHT_OPTIONS}
      HEADERS ${FLEXURA_PCH_HEADERS})
    set(cases 3000)
    if(FLEXURA_SANITIZE)  # Rendering a scene takes ten times as long with a sanitizer.
      set(cases 1000)
    endif()
    add_test(NAME ${stem}
      COMMAND ${stem} --corpus ${PROJECT_SOURCE_DIR}/tests/corpus/${stem} --cases ${cases} --seed 1)
    set_tests_properties(${stem} PROPERTIES LABELS quick TIMEOUT 300)
  endif()
endfunction()
