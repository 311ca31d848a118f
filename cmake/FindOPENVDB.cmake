# OpenVDB and the TBB it needs: OPENVDB_FOUND and the target OPENVDB::OPENVDB. Debian's own FindOpenVDB.cmake lies outside
# CMake's path and asks for Boost, Blosc and more, which only OpenVDB itself needs; this module is installed beside
# drapeConfig.cmake, because a static libdrape passes the library on to its users.
find_path(OPENVDB_INCLUDE_DIR openvdb/openvdb.h)
find_library(OPENVDB_LIBRARY openvdb)
find_library(OPENVDB_TBB_LIBRARY tbb)
# Its headers ask Imath for numbers of 16 bits where the processor that is compiled for cannot convert them. Old versions of OpenVDB have
# such numbers of their own, and no Imath.
find_library(OPENVDB_IMATH_LIBRARY NAMES Imath)
mark_as_advanced(OPENVDB_INCLUDE_DIR OPENVDB_LIBRARY OPENVDB_TBB_LIBRARY OPENVDB_IMATH_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OPENVDB REQUIRED_VARS OPENVDB_LIBRARY OPENVDB_TBB_LIBRARY OPENVDB_INCLUDE_DIR)

if(OPENVDB_FOUND AND NOT TARGET OPENVDB::OPENVDB)
  add_library(OPENVDB::OPENVDB UNKNOWN IMPORTED)
  set_target_properties(OPENVDB::OPENVDB PROPERTIES IMPORTED_LOCATION "${OPENVDB_LIBRARY}"
                                                    INTERFACE_INCLUDE_DIRECTORIES "${OPENVDB_INCLUDE_DIR}"
                                                    INTERFACE_LINK_LIBRARIES "${OPENVDB_TBB_LIBRARY}")
  if(OPENVDB_IMATH_LIBRARY)
    set_property(TARGET OPENVDB::OPENVDB APPEND PROPERTY INTERFACE_LINK_LIBRARIES "${OPENVDB_IMATH_LIBRARY}")
  endif()
endif()
