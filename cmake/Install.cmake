# Installation: the libraries, their public headers and find_package(flexura).
include(CMakePackageConfigHelpers)
get_property(folders GLOBAL PROPERTY FLEXURA_FOLDERS)

# flexura::flexura links every folder.
add_library(flexura_all INTERFACE)
add_library(flexura::flexura ALIAS flexura_all)
set_target_properties(flexura_all PROPERTIES EXPORT_NAME flexura)
list(TRANSFORM folders PREPEND flexura_ OUTPUT_VARIABLE targets)
target_link_libraries(flexura_all INTERFACE ${targets})

install(TARGETS flexura_all ${targets} EXPORT flexuraTargets)
install(TARGETS flexura DESTINATION ${CMAKE_INSTALL_BINDIR})
# The program generates its own manual page and completion scripts.
set(manual ${PROJECT_BINARY_DIR}/flexura.1)
set(bash_completion ${PROJECT_BINARY_DIR}/flexura.bash)
set(zsh_completion ${PROJECT_BINARY_DIR}/_flexura)
install(CODE "
  execute_process(COMMAND \"$<TARGET_FILE:flexura>\" man OUTPUT_FILE \"${manual}\" COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND \"$<TARGET_FILE:flexura>\" completion bash OUTPUT_FILE \"${bash_completion}\" COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND \"$<TARGET_FILE:flexura>\" completion zsh OUTPUT_FILE \"${zsh_completion}\" COMMAND_ERROR_IS_FATAL ANY)")
install(FILES ${manual} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${bash_completion} DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME flexura)
install(FILES ${zsh_completion} DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS flexura/public_headers.txt)
file(STRINGS flexura/public_headers.txt headers REGEX "^[a-z]")
foreach(header ${headers})
  cmake_path(GET header PARENT_PATH folder)
  install(FILES flexura/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/flexura/${folder})
endforeach()
set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/flexura)
install(EXPORT flexuraTargets NAMESPACE flexura:: DESTINATION ${config_dir})
get_property(found_packages GLOBAL PROPERTY FLEXURA_FIND_PACKAGES)
if(found_packages)
  string(PREPEND found_packages "find_dependency(PkgConfig)\n")
endif()
configure_package_config_file(cmake/flexuraConfig.cmake.in
  ${PROJECT_BINARY_DIR}/flexuraConfig.cmake INSTALL_DESTINATION ${config_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/flexuraConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/flexuraConfig.cmake
  ${PROJECT_BINARY_DIR}/flexuraConfigVersion.cmake DESTINATION ${config_dir})
