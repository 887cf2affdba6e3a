# What scripts/package makes a Debian package from. Only where this package is the whole project: in
# a catkin workspace, packaging is not its own business.
if(NOT CMAKE_SOURCE_DIR STREQUAL PROJECT_SOURCE_DIR)
  return()
endif()
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME ros-sampled-data-observers)
set(CPACK_PACKAGE_VERSION ${${PROJECT_NAME}_VERSION})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Real-time state observers for ROS, with guarantees")
set(CPACK_PACKAGE_CONTACT "${${PROJECT_NAME}_MAINTAINER}")
set(CPACK_PACKAGING_INSTALL_PREFIX ${CMAKE_INSTALL_PREFIX})
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Its own libraries, which depend on each other.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CATKIN_DEVEL_PREFIX}/lib)
# Beside the libraries that programs link: what starts and plays them, and what packages that use
# the headers and messages compile with.
file(STRINGS cmake/run_packages.txt run_packages REGEX "^[a-z]")
string(REPLACE ";" ", " CPACK_DEBIAN_PACKAGE_DEPENDS "${run_packages}")
include(CPack)
