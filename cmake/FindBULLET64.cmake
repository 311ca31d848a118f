# The collision part of Bullet in double precision: BULLET64_FOUND and the target BULLET64::BULLET64, which brings no folder of headers: BULLET64_INCLUDE_DIR. Bullet's own package names
# the libraries in single precision only; this module is installed beside drapeConfig.cmake, because a static libdrape passes the
# library on to its users.
find_path(BULLET64_INCLUDE_DIR btBulletCollisionCommon.h PATH_SUFFIXES bullet)
find_library(BULLET64_COLLISION_LIBRARY BulletCollision-float64)
find_library(BULLET64_MATH_LIBRARY LinearMath-float64)
mark_as_advanced(BULLET64_INCLUDE_DIR BULLET64_COLLISION_LIBRARY BULLET64_MATH_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(BULLET64 REQUIRED_VARS BULLET64_COLLISION_LIBRARY BULLET64_MATH_LIBRARY BULLET64_INCLUDE_DIR)

if(BULLET64_FOUND AND NOT TARGET BULLET64::BULLET64)
  add_library(BULLET64::BULLET64 UNKNOWN IMPORTED)
  set_target_properties(BULLET64::BULLET64 PROPERTIES IMPORTED_LOCATION "${BULLET64_COLLISION_LIBRARY}"
                                                      INTERFACE_LINK_LIBRARIES "${BULLET64_MATH_LIBRARY}")
endif()
