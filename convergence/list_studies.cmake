# Writes all_studies() (studies.h): every function that begins with a line `Study NAME() {` in the
# folders below, folder by folder and file by file. Usage: cmake -D OUT=FILE -P list_studies.cmake
set(folders integrators stability damping work_precision any_case conjugate_gradients bending
  level_sets contact strain sticking validation)

set(declarations "")
set(calls "")
foreach(folder ${folders})
  file(GLOB sources ${CMAKE_CURRENT_LIST_DIR}/${folder}/*.cpp)
  foreach(source ${sources})
    file(STRINGS ${source} heads REGEX "^Study [a-z0-9_]+\\(\\) {$")
    foreach(head ${heads})
      string(REGEX REPLACE "^Study (.+) {$" "\\1" call "${head}")
      string(APPEND declarations "Study ${call};\n")
      string(APPEND calls "          ${call},\n")
    endforeach()
  endforeach()
endforeach()

# A study that is written in another way, or stands in another folder, would be left out.
file(GLOB sources ${CMAKE_CURRENT_LIST_DIR}/*/*.cpp)
foreach(source ${sources})
  file(STRINGS ${source} heads REGEX "Study [a-z0-9_]+_study\\(")
  foreach(head ${heads})
    string(REGEX REPLACE ".*Study ([a-z0-9_]+_study)\\(.*" "\\1" name "${head}")
    if(NOT calls MATCHES " ${name}\\(\\),")
      message(FATAL_ERROR "${source}: ${name} is not listed. Begin its definition with a line "
        "'Study ${name}() {', and name its folder in list_studies.cmake.")
    endif()
  endforeach()
endforeach()

file(WRITE ${OUT} "// Written by convergence/list_studies.cmake.
#include \"convergence/studies.h\"

namespace foldproof {

${declarations}
std::vector<Study> all_studies() {
  return {
${calls}  };
}

}  // namespace foldproof
")
