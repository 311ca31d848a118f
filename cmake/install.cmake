# What `cmake --install` puts where: the library and its public headers, the package for find_package(drape), the licence.
# The headers are listed room by room (mesh/, constraints/, solver/); the program and the fabrics in app/.
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/drape)

# <drape/drape.h> in the build tree, too.
configure_file(solver/drape.h include/drape/drape.h COPYONLY)
install(FILES solver/drape.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/drape)

set_target_properties(drape PROPERTIES VERSION ${PROJECT_VERSION}
                                       SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
install(TARGETS drape EXPORT drapeTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
                                          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT drapeTargets NAMESPACE drape:: DESTINATION ${package_dir})
# Apart, since it asks for libraries that who wants only drape::drape need not have.
set_target_properties(drape_app PROPERTIES EXPORT_NAME app)
install(TARGETS drape_app EXPORT drapeAppTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT drapeAppTargets NAMESPACE drape:: DESTINATION ${package_dir})
set(data_dir ${CMAKE_INSTALL_DATADIR}/drape)

# As 0 or 1, so that the file reads if(NOT 0).
foreach(name BUILD_SHARED_LIBS DRAPE_HAVE_BULLET DRAPE_HAVE_CHOLMOD DRAPE_HAVE_OPENVDB DRAPE_HAVE_SUNDIALS)
  if(${name})
    set(${name} 1)
  else()
    set(${name} 0)
  endif()
endforeach()
configure_package_config_file(cmake/drapeConfig.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/drapeConfig.cmake
                              INSTALL_DESTINATION ${package_dir} PATH_VARS data_dir NO_SET_AND_CHECK_MACRO)
# Before version 1 a minor version may change the interface.
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/drapeConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/drapeConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/drapeConfigVersion.cmake
        DESTINATION ${package_dir})
install(FILES cmake/FindUDUNITS2.cmake cmake/FindLIBCSV.cmake DESTINATION ${package_dir})
if(DRAPE_HAVE_BULLET)
  install(FILES cmake/FindBULLET64.cmake DESTINATION ${package_dir})
endif()
if(DRAPE_HAVE_CHOLMOD)
  install(FILES cmake/FindCHOLMOD.cmake DESTINATION ${package_dir})
endif()
if(DRAPE_HAVE_OPENVDB)
  install(FILES cmake/FindOPENVDB.cmake DESTINATION ${package_dir})
endif()
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
