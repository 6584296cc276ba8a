# SPDX-License-Identifier: BSD-3-Clause
# Installation: libraries, headers, and package files for find_package and pkg-config.
include(CMakePackageConfigHelpers)

set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/kacanov")

# Everything that is installed; tools/quickstart run builds this target only.
add_custom_target(kacanov_installed)

# One export set per target, so that a consumer needs only the dependencies of the components it requests.
# Components are installed separately: `cmake --install BUILD --component kernels|solve|solver|program`.
function(kacanov_install_target name target component)
  add_dependencies(kacanov_installed ${target})
  install(TARGETS ${target} EXPORT kacanov-${name}
    ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT ${component}
    LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT ${component})
  install(EXPORT kacanov-${name} NAMESPACE kacanov:: DESTINATION "${package_dir}"
    FILE kacanov-${name}.cmake COMPONENT ${component})
endfunction()

kacanov_install_target(kernels kacanov_kernels kernels)
install(DIRECTORY kernels/include/ DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT kernels)
kacanov_install_target(c kacanov_c kernels)
if(KACANOV_SOLVER)
  kacanov_install_target(solver kacanov_solver solver)
  install(DIRECTORY solver/include/ DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT solver)
  # One library that contains the whole solver, for consumers without its dependencies.
  kacanov_install_target(solve kacanov_solve solve)
  install(DIRECTORY tools/include/ DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT solve)
  install(FILES cmake/FindHYPRE.cmake cmake/FindPARPACK.cmake DESTINATION "${package_dir}" COMPONENT solver)
endif()
if(TARGET kacanov)
  add_dependencies(kacanov_installed kacanov kacanov_said)
  install(TARGETS kacanov RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT program)
  install(FILES "${KACANOV_SAID}/case.schema.json" DESTINATION "${CMAKE_INSTALL_DATADIR}/kacanov" COMPONENT program)
  install(FILES "${KACANOV_SAID}/kacanov.1" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" COMPONENT program)
  install(FILES "${KACANOV_SAID}/kacanov.bash" DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions"
    RENAME kacanov COMPONENT program)
  install(DIRECTORY tools/examples DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT program)
  install(DIRECTORY docs/ DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT program PATTERN examples EXCLUDE)
  install(FILES LICENSE CHANGELOG.md CITATION.cff DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT program)
endif()

configure_package_config_file(cmake/kacanovConfig.cmake.in kacanovConfig.cmake
  INSTALL_DESTINATION "${package_dir}")
write_basic_package_version_file(kacanovConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES
  "${CMAKE_CURRENT_BINARY_DIR}/kacanovConfig.cmake"
  "${CMAKE_CURRENT_BINARY_DIR}/kacanovConfigVersion.cmake"
  cmake/FindMETIS.cmake
  DESTINATION "${package_dir}" COMPONENT kernels)

# pkg-config files find their prefix relative to their own location, so that an installed tree can be moved;
# absolute install paths are kept.
if(IS_ABSOLUTE "${CMAKE_INSTALL_LIBDIR}")
  set(pc_prefix "${CMAKE_INSTALL_PREFIX}")
  set(pc_libdir "${CMAKE_INSTALL_LIBDIR}")
else()
  file(RELATIVE_PATH up "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/")
  string(REGEX REPLACE "/$" "" up "${up}")
  set(pc_prefix "\${pcfiledir}/${up}")
  set(pc_libdir "\${prefix}/${CMAKE_INSTALL_LIBDIR}")
endif()
set(pc_includedir "${CMAKE_INSTALL_INCLUDEDIR}")
if(NOT IS_ABSOLUTE "${CMAKE_INSTALL_INCLUDEDIR}")
  set(pc_includedir "\${prefix}/${CMAKE_INSTALL_INCLUDEDIR}")
endif()
function(kacanov_install_pkg_config package component)
  configure_file(cmake/${package}.pc.in ${package}.pc @ONLY)
  install(FILES "${CMAKE_CURRENT_BINARY_DIR}/${package}.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig"
    COMPONENT ${component})
endfunction()
kacanov_install_pkg_config(kacanov kernels)
kacanov_install_pkg_config(kacanov-kernels kernels)
if(KACANOV_SOLVER)
  kacanov_install_pkg_config(kacanov-solve solve)
endif()
