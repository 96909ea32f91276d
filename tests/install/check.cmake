# Installs the build in BINARY_DIR to PREFIX, then builds and runs the project beside this file against it (script
# mode). WORK_DIR is for its build.
foreach(folder ${PREFIX} ${WORK_DIR})
  file(REMOVE_RECURSE ${folder})
endforeach()

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()
run(${CMAKE_COMMAND} --install ${BINARY_DIR} --prefix ${PREFIX})
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK_DIR} -G Ninja -DCMAKE_PREFIX_PATH=${PREFIX})
run(${CMAKE_COMMAND} --build ${WORK_DIR})
execute_process(COMMAND ${WORK_DIR}/my_arm OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
if(NOT output STREQUAL "E = (-10.738, 5.201)\n")
  message(FATAL_ERROR "my_arm printed: ${output}")
endif()
run(${PREFIX}/bin/flexura --version)
