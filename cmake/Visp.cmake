# flexura_link_visp_peer(TARGET)
#
# Makes ViSP's results available to a test or a benchmark as plain numbers (tests/support/visp_peer.h). ViSP is under
# the GPL: it is never linked into the library or the program. Its Debian packages contain no CMake files, and its
# headers are not valid C++20.
function(flexura_link_visp_peer target)
  if(NOT TARGET visp_peer)
    find_path(VISP_INCLUDE_DIR visp3/vs/vpServo.h REQUIRED)
    add_library(visp_peer STATIC ${PROJECT_SOURCE_DIR}/tests/support/visp_peer.cc)
    target_include_directories(visp_peer PRIVATE ${PROJECT_SOURCE_DIR})
    target_include_directories(visp_peer SYSTEM PRIVATE ${VISP_INCLUDE_DIR})
    target_link_libraries(visp_peer PRIVATE visp_vs visp_visual_features visp_core)
    set_target_properties(visp_peer PROPERTIES CXX_STANDARD 17 CXX_STANDARD_REQUIRED ON)
  endif()
  target_link_libraries(${target} PRIVATE visp_peer)
endfunction()
