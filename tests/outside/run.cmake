# Installs the build BUILD_DIR, moves what was installed, then configures, builds and runs the outside program against it.
#   cmake -DBUILD_DIR= -DCONFIG= -DWORK_DIR= -DGENERATOR= -DCXX= -P run.cmake
function(run what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${what} failed (${result}):\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK_DIR})
run("the installation" ${CMAKE_COMMAND} --install ${BUILD_DIR} --config ${CONFIG} --prefix ${WORK_DIR}/first)
file(RENAME ${WORK_DIR}/first ${WORK_DIR}/prefix)

# Nothing installed may name the folders it was made in.
file(GLOB_RECURSE package ${WORK_DIR}/prefix/*.cmake ${WORK_DIR}/prefix/*.h)
foreach(file ${package})
  file(READ ${file} text)
  foreach(path ${BUILD_DIR} ${SOURCE_DIR} ${WORK_DIR})
    string(FIND "${text}" "${path}" position)
    if(NOT position EQUAL -1)
      message(FATAL_ERROR "${file} names ${path}: it cannot be moved to another place")
    endif()
  endforeach()
endforeach()

run("configuring the outside program" ${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${WORK_DIR}/build -G ${GENERATOR}
    -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_BUILD_TYPE=${CONFIG} -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix)
run("building the outside program" ${CMAKE_COMMAND} --build ${WORK_DIR}/build)
run("the outside program" ${WORK_DIR}/build/outside)
message("${output}")
run("the installed drape" ${WORK_DIR}/prefix/bin/drape list)
