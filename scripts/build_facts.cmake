# Writes build_facts.h: which sources, compiler and flags made the program. Run by every build; the
# file changes only when a fact does. cmake -D FOLDER=... -D OUT=... -D VERSION=... -D COMPILER=...
# -D FLAGS=... -D BUILD_TYPE=... -P build_facts.cmake
execute_process(COMMAND git -C ${FOLDER} rev-parse HEAD OUTPUT_VARIABLE commit
  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE no_git)
execute_process(COMMAND git -C ${FOLDER} status --porcelain OUTPUT_VARIABLE changes ERROR_QUIET)
set(tree clean)
if(no_git)
  set(commit unknown)
  set(tree unknown)
elseif(NOT changes STREQUAL "")
  set(tree dirty)
endif()
set(text "#define FOLDPROOF_VERSION \"${VERSION}\"
#define FOLDPROOF_COMMIT \"${commit}\"
#define FOLDPROOF_TREE \"${tree}\"
#define FOLDPROOF_COMPILER \"${COMPILER}\"
#define FOLDPROOF_FLAGS \"${FLAGS}\"
#define FOLDPROOF_BUILD_TYPE \"${BUILD_TYPE}\"
#define FOLDPROOF_FOLDER \"${FOLDER}\"
")
if(EXISTS ${OUT})
  file(READ ${OUT} before)
endif()
if(NOT "${before}" STREQUAL "${text}")
  file(WRITE ${OUT} "${text}")
endif()
