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

# The scene of the outside program, by the installed drape and by that program.
file(WRITE ${WORK_DIR}/pillow.toml [=[
unit = "1 cm"
[[panel]]
name = "a"
outline = [[0, 0], [40, 0], [20, 35]]
sides = ["x", "y", "z"]
[[panel]]
name = "b"
outline = [[60, 0], [100, 0], [80, 35]]
sides = ["x", "y", "z"]
[[seam]]
curves = ["a.x", "b.x"]
]=])
file(WRITE ${WORK_DIR}/scene.toml [=[
simulation = { duration = 0.4, time_step = 0.01 }
[[cloth]]
mesh = "pillow.toml"
edge = "6 cm"
fabric = "cotton-poplin"
panels = [{ group = "a" }, { group = "b", rotate = { axis = [0, 1, 0], angle = "180 deg" }, translate = [0, 0, -0.02] }]
seams = [{ close = 0.2 }]
[[obstacle]]
shape = "plane"
point = [0, -0.3, 0]
]=])
set(ENV{DRAPE_DATA} "")
run("the installed drape simulate" ${WORK_DIR}/prefix/bin/drape simulate ${WORK_DIR}/scene.toml --out ${WORK_DIR}/out --frames none --quiet)
file(READ ${WORK_DIR}/out/run.json record)
string(JSON hash GET "${record}" state_hash)
run("the outside program of a scene" ${WORK_DIR}/build/outside_scene ${WORK_DIR}/scene.toml ${hash} ${WORK_DIR}/out_again)
message("${output}")
file(READ ${WORK_DIR}/out_again/run.json record)
string(JSON again GET "${record}" state_hash)
if(NOT again STREQUAL hash)
  message(FATAL_ERROR "drape::app::run made the state ${again}, drape simulate ${hash}")
endif()
