# The programs that asset builds run. In a cross build those that were built for the target do not run on this machine:
# PFVOX_HOST_TOOLS_DIR names a folder of programs that do. Part of PfvoxAssets.cmake.
set(PFVOX_HOST_TOOLS_DIR "" CACHE PATH "Folder of the pfvox programs that run on this machine; for cross builds")

# Makes pfvox::<program> the one of PFVOX_HOST_TOOLS_DIR. Nothing where the folder is not set or has no such program.
function(_pfvox_use_host_program program)
  set(file "${PFVOX_HOST_TOOLS_DIR}/${program}")
  if(NOT PFVOX_HOST_TOOLS_DIR OR NOT EXISTS "${file}")
    return()
  endif()
  if(NOT TARGET pfvox::${program})
    add_executable(pfvox::${program} IMPORTED GLOBAL)
  endif()
  set_target_properties(pfvox::${program} PROPERTIES
    IMPORTED_CONFIGURATIONS HOST IMPORTED_LOCATION_HOST "${file}" IMPORTED_LOCATION "${file}")
endfunction()

# pfvox_name_program(<target>): names a program of this project as its package does.
function(pfvox_name_program target)
  _pfvox_use_host_program(${target})
  if(NOT TARGET pfvox::${target})
    add_executable(pfvox::${target} ALIAS ${target})
  endif()
endfunction()

function(_pfvox_check_host function target program)
  get_target_property(imported pfvox::${program} IMPORTED)
  if(CMAKE_CROSSCOMPILING AND NOT CMAKE_CROSSCOMPILING_EMULATOR AND NOT imported)
    message(FATAL_ERROR "${function}(${target}): ${program} is built for ${CMAKE_SYSTEM_NAME} ${CMAKE_SYSTEM_PROCESSOR} and does "
      "not run on this machine. Set PFVOX_HOST_TOOLS_DIR to the folder of one that does, for example /usr/bin of pfvox-tools.")
  endif()
endfunction()
