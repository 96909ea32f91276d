# Runs EXPERIMENT with FLEXURA in the empty folder WORK_DIR and tests its report in a browser (report_test.mjs).
file(REMOVE_RECURSE ${WORK_DIR})
execute_process(COMMAND ${FLEXURA} run ${EXPERIMENT} --out ${WORK_DIR}/run COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${NODE} ${CMAKE_CURRENT_LIST_DIR}/report_test.mjs ${WORK_DIR}/run/report.html
  COMMAND_ERROR_IS_FATAL ANY)
