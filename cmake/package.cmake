# SPDX-License-Identifier: BSD-3-Clause
# The Debian package: `cpack -G DEB` in the build folder packages everything that `cmake --install` installs.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME kacanov)
set(CPACK_PACKAGE_VERSION "${PROJECT_VERSION}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_DESCRIPTION
  "kacanov computes how elastoplastic bodies deform in contact with rigid
obstacles, with friction, in two and three dimensions, by matrix-free finite
elements. This package has the program, its examples and documents, the C
library and the C++ libraries with their headers.")
set(CPACK_PACKAGE_CONTACT "the kacanov authors <kacanov@example.org>")
set(CPACK_PACKAGE_DIRECTORY "${PROJECT_BINARY_DIR}/package")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
# Independent of the builder's umask.
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
file(WRITE "${PROJECT_BINARY_DIR}/triggers" "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA "${PROJECT_BINARY_DIR}/triggers")
# mpiexec starts the ranks; the suggested packages are for linking the C++ libraries.
set(CPACK_DEBIAN_PACKAGE_DEPENDS openmpi-bin)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS
  "gmsh, paraview, libopenmpi-dev, libhypre-dev, libmetis-dev, libparpack2-dev, libarpack2-dev, libeigen3-dev")

# Debian requires its own, compressed files in /usr/share/doc. The date is that of the release.
find_program(GZIP gzip)
if(GZIP)
  file(STRINGS CITATION.cff released REGEX "^date-released:")
  string(REGEX REPLACE "^date-released: *" "" released "${released}")
  configure_file(cmake/package_files.cmake.in package_files.cmake @ONLY)
  set(CPACK_PRE_BUILD_SCRIPTS "${PROJECT_BINARY_DIR}/package_files.cmake")
endif()
include(CPack)
