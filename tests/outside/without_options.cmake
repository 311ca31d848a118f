# Configures a build without the optional parts of the library, and looks whether the program drape_without_options of the tests compiles
# all files itself that ask for these parts.
#   cmake -DSOURCE_DIR= -DWORK_DIR= -DGENERATOR= -DCXX= -DABOUT_OPTIONS= -P without_options.cmake
execute_process(
  COMMAND ${CMAKE_COMMAND} -S ${SOURCE_DIR} -B ${WORK_DIR} -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${CXX} -DDRAPE_CHOLMOD=OFF
          -DDRAPE_SUNDIALS=OFF -DDRAPE_OPENVDB=OFF -DDRAPE_BULLET=OFF -DDRAPE_NATIVE=OFF -DDRAPE_VIEWER=OFF -DDRAPE_TESTS=OFF
  RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "configuring failed (${result}):\n${output}")
endif()

file(GLOB_RECURSE files RELATIVE ${SOURCE_DIR} ${SOURCE_DIR}/mesh/*.cpp ${SOURCE_DIR}/mesh/*.h ${SOURCE_DIR}/constraints/*.cpp
     ${SOURCE_DIR}/constraints/*.h ${SOURCE_DIR}/solver/*.cpp ${SOURCE_DIR}/solver/*.h)
foreach(file ${files})
  file(STRINGS ${SOURCE_DIR}/${file} asks REGEX "DRAPE_HAVE_")
  if(asks)
    list(APPEND asking ${file})
  endif()
endforeach()
list(SORT asking)
list(SORT ABOUT_OPTIONS)
if(NOT asking STREQUAL ABOUT_OPTIONS)
  message(FATAL_ERROR "tests/CMakeLists.txt names ${ABOUT_OPTIONS}, but the files that name DRAPE_HAVE_... are ${asking}")
endif()
