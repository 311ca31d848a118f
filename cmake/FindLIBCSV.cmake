# libcsv: LIBCSV_FOUND and the target LIBCSV::LIBCSV. It brings no CMake package of its own; this module is installed beside
# drapeConfig.cmake, because drape::app is static and passes the library on to its users.
find_path(LIBCSV_INCLUDE_DIR csv.h)
find_library(LIBCSV_LIBRARY csv)
mark_as_advanced(LIBCSV_INCLUDE_DIR LIBCSV_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(LIBCSV REQUIRED_VARS LIBCSV_LIBRARY LIBCSV_INCLUDE_DIR)

if(LIBCSV_FOUND AND NOT TARGET LIBCSV::LIBCSV)
  add_library(LIBCSV::LIBCSV UNKNOWN IMPORTED)
  set_target_properties(LIBCSV::LIBCSV PROPERTIES IMPORTED_LOCATION "${LIBCSV_LIBRARY}"
                                                  INTERFACE_INCLUDE_DIRECTORIES "${LIBCSV_INCLUDE_DIR}")
endif()
