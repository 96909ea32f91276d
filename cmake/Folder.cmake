# flexura_folder(NAME [LINKS targets...] [PRIVATE_LINKS targets...])
#
# Makes the library flexura::NAME from the current folder: every *.cc and *.h in it, but for
#   *_test.cc       quick tests    -> executable NAME_test,       ctest NAME,      label quick
#   *_full_test.cc  longer tests   -> executable NAME_full_test,  ctest NAME.full, label full
#   *_fuzz.cc       fuzz targets   -> executable each (see flexura_fuzz_target)
# LINKS is the law of the architecture: what is not listed there cannot be included.
function(flexura_folder name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "LINKS;PRIVATE_LINKS")
  file(GLOB sources CONFIGURE_DEPENDS *.cc *.h)
  set(tests ${sources})
  set(fuzzers ${sources})
  list(FILTER sources EXCLUDE REGEX "(_test|_fuzz|/main)[.]cc$")
  list(FILTER tests INCLUDE REGEX "_test[.]cc$")
  list(FILTER fuzzers INCLUDE REGEX "_fuzz[.]cc$")

  add_library(flexura_${name} STATIC ${sources})
  add_library(flexura::${name} ALIAS flexura_${name})
  set_target_properties(flexura_${name} PROPERTIES EXPORT_NAME ${name} LINKER_LANGUAGE CXX)
  target_include_directories(flexura_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_link_libraries(flexura_${name} PUBLIC ${arg_LINKS}
    PRIVATE ${arg_PRIVATE_LINKS} $<BUILD_INTERFACE:flexura_settings>)
  target_compile_features(flexura_${name} PUBLIC cxx_std_20)
  set_property(GLOBAL APPEND PROPERTY FLEXURA_FOLDERS ${name})

  if(FLEXURA_TESTS)
    set(full_tests ${tests})
    list(FILTER tests EXCLUDE REGEX "_full_test[.]cc$")
    list(FILTER full_tests INCLUDE REGEX "_full_test[.]cc$")
    flexura_test(${name}_test ${name} quick ${name} ${tests})
    if(FLEXURA_FULL_TESTS)
      flexura_test(${name}_full_test ${name}.full full ${name} ${full_tests})
    endif()
  endif()
  foreach(source ${fuzzers})
    cmake_path(GET source STEM stem)
    flexura_fuzz_target(${stem} ${name} ${source})
  endforeach()
endfunction()

# One test executable for a folder and a size; nothing when there are no sources.
function(flexura_test executable ctest_name label folder)
  if(NOT ARGN)
    return()
  endif()
  add_executable(${executable} ${ARGN})
  target_link_libraries(${executable} PRIVATE
    flexura::${folder} flexura_settings GTest::gtest_main GTest::gmock)
  target_compile_definitions(${executable} PRIVATE
    FLEXURA_SOURCE_DIR="${PROJECT_SOURCE_DIR}" FLEXURA_BINARY_DIR="${CMAKE_BINARY_DIR}")
  if(FLEXURA_PCH)
    target_precompile_headers(${executable} PRIVATE <gtest/gtest.h> <gmock/gmock.h> <Eigen/Dense>)
    target_include_directories(${executable} SYSTEM PRIVATE
      $<TARGET_PROPERTY:Eigen3::Eigen,INTERFACE_INCLUDE_DIRECTORIES>)
  endif()
  add_test(NAME ${ctest_name} COMMAND ${executable})
  set_tests_properties(${ctest_name} PROPERTIES LABELS ${label} TIMEOUT 600)
endfunction()

# A file with LLVMFuzzerTestOneInput becomes two programs' worth of use: with FLEXURA_FUZZ it is a libFuzzer
# executable; otherwise it is linked with tests/fuzz_driver.cc, which replays the committed corpus
# (tests/corpus/STEM) and seeded mutations of it, and runs as a quick test.
function(flexura_fuzz_target stem folder source)
  if(NOT FLEXURA_FUZZ AND NOT FLEXURA_TESTS)
    return()
  endif()
  if(FLEXURA_FUZZ)
    add_executable(${stem} ${source})
    target_link_libraries(${stem} PRIVATE flexura::${folder} flexura_settings)
    target_link_options(${stem} PRIVATE -fsanitize=fuzzer)
  else()
    add_executable(${stem} ${source} ${PROJECT_SOURCE_DIR}/tests/fuzz_driver.cc)
    target_link_libraries(${stem} PRIVATE flexura::${folder} flexura_settings)
    add_test(NAME ${stem} COMMAND ${stem} --corpus ${PROJECT_SOURCE_DIR}/tests/corpus/${stem} --cases 3000 --seed 1)
    set_tests_properties(${stem} PROPERTIES LABELS quick TIMEOUT 300)
  endif()
endfunction()
