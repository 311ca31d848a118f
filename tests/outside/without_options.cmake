# Configures and builds the library without its optional parts.
#   cmake -DSOURCE_DIR= -DWORK_DIR= -DGENERATOR= -DCXX= -DLAUNCHER= -P without_options.cmake
foreach(step "configure" "build")
  if(step STREQUAL "configure")
    set(command -S ${SOURCE_DIR} -B ${WORK_DIR} -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}
        -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0 -DDRAPE_WERROR=ON -DDRAPE_CHOLMOD=OFF -DDRAPE_SUNDIALS=OFF
        -DDRAPE_OPENVDB=OFF -DDRAPE_BULLET=OFF -DDRAPE_NATIVE=OFF -DDRAPE_VIEWER=OFF -DDRAPE_TESTS=OFF)
  else()
    set(command --build ${WORK_DIR} --target drape_library)
  endif()
  execute_process(COMMAND ${CMAKE_COMMAND} ${command} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${step} failed (${result}):\n${output}")
  endif()
endforeach()
