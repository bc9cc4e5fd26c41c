# What the program reads and the Python package, for the Debian package and the wheel.
cmake_path(GET CMAKE_CURRENT_LIST_DIR PARENT_PATH tree)
cmake_path(GET tree PARENT_PATH tree)
set(data share/foldproof)

# Below this folder, which ends in / or is empty.
function(install_data prefix)
  set(to ${prefix}${data})
  install(DIRECTORY ${tree}/cases DESTINATION ${to} PATTERN *.md EXCLUDE)
  install(FILES ${tree}/cases/KEYS.md DESTINATION ${to}/cases)  # the report reads units there
  install(DIRECTORY ${tree}/verification/claims ${tree}/verification/faults
    DESTINATION ${to}/verification FILES_MATCHING PATTERN *.toml PATTERN outcomes.json)
  install(FILES ${tree}/verification/subjects/planted_bugs.jsonl
    DESTINATION ${to}/verification/subjects)
  install(DIRECTORY ${tree}/verification/subjects/law_sets ${tree}/verification/subjects/adapters
    DESTINATION ${to}/verification/subjects PATTERN __pycache__ EXCLUDE)
  install(DIRECTORY ${tree}/reports DESTINATION ${to} FILES_MATCHING
    PATTERN *.py PATTERN *.j2 PATTERN *.css PATTERN *.js PATTERN *.json
    PATTERN tests EXCLUDE PATTERN __pycache__ EXCLUDE)
endfunction()

# An adapter's base in the package is the file that users without Python's package copy.
function(install_python folder)
  install(FILES ${tree}/scripts/package/python/foldproof/__init__.py
    ${tree}/scripts/package/python/foldproof/py.typed
    DESTINATION ${folder}/foldproof)
  install(FILES ${tree}/verification/subjects/adapters/foldproof_solver.py
    DESTINATION ${folder}/foldproof RENAME solver.py)
endfunction()
