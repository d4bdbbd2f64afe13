# Voxel assets and their light as parts of a build. Every argument, with examples: docs/cmake.md.
#
# pfvox_add_assets(<target> [ALL]
#   SOURCES <file>...            voxel sources and scenes (.toml), relative to BASE_DIR
#   [BASE_DIR <folder>]          root of the tree that is mirrored; default CMAKE_CURRENT_SOURCE_DIR
#   [OUTPUT_DIR <folder>]        default CMAKE_CURRENT_BINARY_DIR/<target>
#   [SETTINGS <file>]            vox2pf settings (TOML)
#   [OPTIONS <option>...]        further options of vox2pf convert
#   [DEPENDS <target | file>...]
#   [PRUNE])                     removes what it made of sources that are gone
#
# pfvox_add_probe_bake(<target> [ALL]
#   SCENE <scene.toml | file.pf_vox>
#   OUTPUT <file.pf_probe>
#   [ASSETS <target>...]         of pfvox_add_assets, whose files the scene names; a scene below the BASE_DIR of one of
#                                them is carried over to its OUTPUT_DIR, and the carried one is baked
#   [OPTIONS <option>...]        further options of probe-bake bake
#   [DEPENDS <target | file>...])
#
# pfvox_install_assets(TARGETS <target>... DESTINATION <folder> [COMPONENT <component>])
#                                installs what these targets make, and nothing else that lies there
#
# pfvox_copy_vdb_module(<target>)  puts OpenVDB support beside a program that links pfvox::import
#
# Properties of the targets: PFVOX_OUTPUTS (absolute paths of what is made), PFVOX_OUTPUT_DIR, PFVOX_BASE_DIR and
# PFVOX_SOURCES; of a bake also PFVOX_SCENE, the scene that is baked. When all is well, nothing is printed.
cmake_policy(PUSH)
cmake_policy(VERSION 3.25) # functions keep the policies under which they were defined
include(${CMAKE_CURRENT_LIST_DIR}/PfvoxAssetNames.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/PfvoxAssetOutputs.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/PfvoxHostTools.cmake)

# Stops when a function was called with what it does not know, or without what it needs. Reads ARG_* of the caller.
function(_pfvox_check_call function target)
  if(ARG_UNPARSED_ARGUMENTS)
    list(JOIN ARG_UNPARSED_ARGUMENTS " " words)
    message(FATAL_ERROR "${function}(${target}): unknown argument: ${words}")
  endif()
  list(REMOVE_ITEM ARG_KEYWORDS_MISSING_VALUES OPTIONS DEPENDS ASSETS) # a list may be an empty variable
  if(ARG_KEYWORDS_MISSING_VALUES)
    list(JOIN ARG_KEYWORDS_MISSING_VALUES ", " words)
    message(FATAL_ERROR "${function}(${target}): nothing follows ${words}")
  endif()
  foreach(keyword IN LISTS ARGN)
    if(NOT ARG_${keyword})
      message(FATAL_ERROR "${function}(${target}): ${keyword} is missing")
    endif()
  endforeach()
  if(TARGET ${target})
    message(FATAL_ERROR "${function}(${target}): there is a target of this name already")
  endif()
endfunction()

function(_pfvox_check_program function target program component)
  if(NOT TARGET pfvox::${program})
    list(JOIN pfvox_${component}_MISSING "; " why)
    if(why)
      string(PREPEND why " Missing: ")
    endif()
    message(FATAL_ERROR "${function}(${target}): the program ${program} is not there. "
      "Install it (Debian package pfvox-tools) and ask for it: find_package(pfvox CONFIG REQUIRED COMPONENTS ${component})."
      "${why}")
  endif()
  _pfvox_check_host(${function} ${target} ${program})
endfunction()

# How outputs that stay the same are kept from building everything behind them: ninja looks at the time stamp again when
# a command has run (restat). make does not: it wants every output newer than its inputs, or runs the command for ever.
function(_pfvox_time_stamp_option result)
  set(option "")
  if(CMAKE_GENERATOR MATCHES "Ninja")
    set(option --if-changed)
  endif()
  set(${result} ${option} PARENT_SCOPE)
endfunction()

function(_pfvox_absolute variable base)
  cmake_path(ABSOLUTE_PATH ${variable} BASE_DIRECTORY "${base}" NORMALIZE)
  string(REGEX REPLACE "(.)/$" "\\1" path "${${variable}}")
  set(${variable} "${path}" PARENT_SCOPE)
endfunction()

# Where the output of a source of an asset target lies; stops when the source is not below BASE_DIR.
function(_pfvox_output_of result source base_dir output_dir)
  cmake_path(IS_PREFIX base_dir "${source}" NORMALIZE below)
  if(NOT below OR source STREQUAL base_dir)
    message(FATAL_ERROR "pfvox: ${source} is not below BASE_DIR ${base_dir}: its place in OUTPUT_DIR is unknown. "
      "Give such sources a pfvox_add_assets of their own, with their folder as BASE_DIR.")
  endif()
  cmake_path(RELATIVE_PATH source BASE_DIRECTORY "${base_dir}" OUTPUT_VARIABLE relative)
  cmake_path(GET source EXTENSION LAST_ONLY extension)
  if(NOT extension STREQUAL ".toml")
    cmake_path(REPLACE_EXTENSION relative LAST_ONLY .pf_vox)
  endif()
  set(${result} "${output_dir}/${relative}" PARENT_SCOPE)
endfunction()

function(_pfvox_depfile result output)
  string(SHA256 name "${output}")
  string(SUBSTRING ${name} 0 16 name)
  set(folder "${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/pfvox")
  file(MAKE_DIRECTORY "${folder}")
  set(${result} "${folder}/${name}.d" PARENT_SCOPE)
endfunction()

# The custom command for one source. Reads base_dir, output_dir, options, settings and inputs of the caller. All that it reads is
# known, so it needs no depfile, which some names could not stand in.
function(_pfvox_convert source output)
  cmake_path(RELATIVE_PATH source BASE_DIRECTORY "${base_dir}" OUTPUT_VARIABLE relative)
  _pfvox_time_stamp_option(time_stamps)
  set(touch "")
  if(NOT time_stamps)
    set(touch COMMAND ${CMAKE_COMMAND} -E touch_nocreate "${output}")
  endif()
  # One thread: the build system runs as many of these commands as there are processors.
  add_custom_command(OUTPUT "${output}"
    COMMAND pfvox::vox2pf convert -j 1 --no-summary ${time_stamps} --base-dir "${base_dir}" ${settings} ${options}
            "${source}" -o "${output_dir}/"
    ${touch}
    DEPENDS pfvox::vox2pf "${source}" ${inputs}
    COMMENT "Converting ${relative}"
    VERBATIM COMMAND_EXPAND_LISTS)
endfunction()

function(pfvox_add_assets target)
  cmake_parse_arguments(PARSE_ARGV 1 ARG "ALL;PRUNE" "BASE_DIR;OUTPUT_DIR;SETTINGS" "SOURCES;OPTIONS;DEPENDS")
  _pfvox_check_call(pfvox_add_assets ${target} SOURCES)
  _pfvox_check_program(pfvox_add_assets ${target} vox2pf tools)

  set(base_dir "${ARG_BASE_DIR}")
  _pfvox_absolute(base_dir "${CMAKE_CURRENT_SOURCE_DIR}")
  set(output_dir "${ARG_OUTPUT_DIR}")
  if(NOT output_dir)
    set(output_dir ${target})
  endif()
  _pfvox_absolute(output_dir "${CMAKE_CURRENT_BINARY_DIR}")
  if(output_dir STREQUAL base_dir)
    message(FATAL_ERROR "pfvox_add_assets(${target}): OUTPUT_DIR is BASE_DIR: outputs do not belong among the sources")
  endif()
  set(options ${ARG_OPTIONS})
  set(inputs ${ARG_DEPENDS})
  set(settings "")
  if(ARG_SETTINGS)
    _pfvox_absolute(ARG_SETTINGS "${CMAKE_CURRENT_SOURCE_DIR}")
    _pfvox_check_path("pfvox_add_assets(${target})" "${ARG_SETTINGS}")
    set(settings --settings "${ARG_SETTINGS}")
    list(APPEND inputs "${ARG_SETTINGS}")
  endif()

  set(sources "")
  set(models "")
  set(scenes "")
  foreach(source IN LISTS ARG_SOURCES)
    _pfvox_check_path("pfvox_add_assets(${target})" "${source}")
    _pfvox_find_source(source "${base_dir}")
    _pfvox_check_path("pfvox_add_assets(${target})" "${source}" "${output_dir}")
    _pfvox_output_of(output "${source}" "${base_dir}" "${output_dir}")
    if(output IN_LIST models OR output IN_LIST scenes)
      message(FATAL_ERROR "pfvox_add_assets(${target}): two sources become ${output}; the second is ${source}")
    endif()
    list(APPEND sources "${source}")
    if(source MATCHES "\\.toml$")
      list(APPEND scenes "${output}")
    else()
      list(APPEND models "${output}")
      _pfvox_convert("${source}" "${output}")
    endif()
  endforeach()
  # Scenes come after their models: their paths are turned to what is there.
  list(APPEND inputs ${models})
  foreach(source IN LISTS sources)
    if(source MATCHES "\\.toml$")
      _pfvox_output_of(output "${source}" "${base_dir}" "${output_dir}")
      _pfvox_convert("${source}" "${output}")
    endif()
  endforeach()

  set(outputs ${models} ${scenes})
  _pfvox_add_target(${target} "${ARG_ALL}" "${outputs}" "${ARG_DEPENDS}")
  set_target_properties(${target} PROPERTIES
    PFVOX_OUTPUTS "${outputs}" PFVOX_SOURCES "${sources}"
    PFVOX_BASE_DIR "${base_dir}" PFVOX_OUTPUT_DIR "${output_dir}")
  _pfvox_remember_outputs(${target} "${outputs}" "${ARG_PRUNE}")
endfunction()

# As people write it: relative to BASE_DIR or, with the folder in front, to the current source folder.
function(_pfvox_find_source variable base_dir)
  set(below_base "${${variable}}")
  _pfvox_absolute(below_base "${base_dir}")
  set(below_current "${${variable}}")
  _pfvox_absolute(below_current "${CMAKE_CURRENT_SOURCE_DIR}")
  cmake_path(IS_PREFIX base_dir "${below_current}" NORMALIZE current_fits)
  if(current_fits AND (EXISTS "${below_current}" OR NOT EXISTS "${below_base}"))
    set(${variable} "${below_current}" PARENT_SCOPE)
  else()
    set(${variable} "${below_base}" PARENT_SCOPE)
  endif()
endfunction()

# A custom target for files, which waits for the targets among what it depends on.
function(_pfvox_add_target target all files depends)
  set(all_option "")
  if(all)
    set(all_option ALL)
  endif()
  add_custom_target(${target} ${all_option} DEPENDS ${files})
  foreach(dependency IN LISTS depends)
    if(TARGET ${dependency})
      add_dependencies(${target} ${dependency})
    endif()
  endforeach()
endfunction()

# The scene as it is baked: `scene` of the caller itself, or what it becomes among the outputs of an asset target.
# Sets `scene`, and `carrier` to the target that carries it over, if that is none of ASSETS.
function(_pfvox_scene_of_assets target)
  foreach(assets IN LISTS ARG_ASSETS)
    get_target_property(base_dir ${assets} PFVOX_BASE_DIR)
    get_target_property(output_dir ${assets} PFVOX_OUTPUT_DIR)
    get_target_property(sources ${assets} PFVOX_SOURCES)
    get_target_property(inputs ${assets} PFVOX_OUTPUTS)
    cmake_path(IS_PREFIX base_dir "${scene}" NORMALIZE is_source)
    cmake_path(IS_PREFIX output_dir "${scene}" NORMALIZE is_output)
    cmake_path(IS_PREFIX output_dir "${base_dir}" NORMALIZE sources_among_outputs)
    if(is_output AND NOT (is_source AND sources_among_outputs))
      return() # named as what it will be
    endif()
    if(NOT is_source)
      continue()
    endif()
    _pfvox_output_of(output "${scene}" "${base_dir}" "${output_dir}")
    if(NOT scene IN_LIST sources)
      _pfvox_carry("${scene}" "${output}")
    endif()
    set(scene "${output}" PARENT_SCOPE)
    set(carrier ${carrier} PARENT_SCOPE)
    return()
  endforeach()
endfunction()

# Carries a scene over for the first bake that asks for it; sets `carrier`, for the others as well. Reads target, assets,
# base_dir, output_dir and inputs of the caller.
function(_pfvox_carry scene output)
  string(SHA256 key "${output}")
  get_property(carrier GLOBAL PROPERTY PFVOX_CARRIER_${key})
  if(NOT carrier)
    set(carrier ${target}_scene)
    _pfvox_check_path("pfvox_add_probe_bake(${target})" "${scene}" "${output}")
    set(options "")
    set(settings "")
    _pfvox_convert("${scene}" "${output}")
    _pfvox_add_target(${carrier} "" "${output}" ${assets})
    _pfvox_remember_outputs(${carrier} "${output}" FALSE)
    set_property(GLOBAL PROPERTY PFVOX_CARRIER_${key} ${carrier})
  endif()
  set(carrier ${carrier} PARENT_SCOPE)
endfunction()

# Bakes run one after the other: they share the GPU. Only ninja knows pools.
function(_pfvox_gpu_pool)
  get_property(pools GLOBAL PROPERTY JOB_POOLS)
  if(NOT pools)
    set(pools ${CMAKE_JOB_POOLS}) # which counts only while the property is not set
  endif()
  if(NOT pools MATCHES "(^|;)pfvox_gpu=")
    set_property(GLOBAL PROPERTY JOB_POOLS ${pools} pfvox_gpu=1)
  endif()
endfunction()

function(pfvox_add_probe_bake target)
  cmake_parse_arguments(PARSE_ARGV 1 ARG "ALL" "SCENE;OUTPUT" "ASSETS;OPTIONS;DEPENDS")
  _pfvox_check_call(pfvox_add_probe_bake ${target} SCENE OUTPUT)
  _pfvox_check_program(pfvox_add_probe_bake ${target} probe-bake tools)
  foreach(assets IN LISTS ARG_ASSETS)
    set(outputs "")
    if(TARGET ${assets})
      get_target_property(outputs ${assets} PFVOX_OUTPUTS)
    endif()
    if(NOT outputs)
      message(FATAL_ERROR "pfvox_add_probe_bake(${target}): ASSETS ${assets} is no target of pfvox_add_assets "
        "(which has to be called first)")
    endif()
  endforeach()
  set(output "${ARG_OUTPUT}")
  _pfvox_absolute(output "${CMAKE_CURRENT_BINARY_DIR}")
  if(NOT output MATCHES "\\.pf_probe$")
    message(FATAL_ERROR "pfvox_add_probe_bake(${target}): OUTPUT ${ARG_OUTPUT} does not end in .pf_probe")
  endif()
  _pfvox_check_path("pfvox_add_probe_bake(${target})" "${ARG_SCENE}" "${ARG_OUTPUT}")
  _pfvox_check_depfile_path("pfvox_add_probe_bake(${target})" "${output}")
  set(scene "${ARG_SCENE}")
  _pfvox_absolute(scene "${CMAKE_CURRENT_SOURCE_DIR}")
  _pfvox_check_path("pfvox_add_probe_bake(${target})" "${scene}")
  set(carrier "")
  _pfvox_scene_of_assets(${target})

  _pfvox_depfile(depfile "${output}")
  cmake_path(GET output FILENAME name)
  _pfvox_time_stamp_option(time_stamps)
  _pfvox_gpu_pool()
  _pfvox_bake_inputs("${output}" "${scene}" "${depfile}")
  add_custom_command(OUTPUT "${output}"
    COMMAND pfvox::probe-bake bake --no-summary ${time_stamps} --depfile "${depfile}" ${depfile_known} ${ARG_OPTIONS}
            "${scene}" -o "${output}"
    DEPENDS pfvox::probe-bake "${scene}" ${named_inputs} ${ARG_DEPENDS}
    DEPFILE "${depfile}"
    JOB_POOL pfvox_gpu
    COMMENT "Baking ${name}"
    VERBATIM COMMAND_EXPAND_LISTS)
  _pfvox_add_target(${target} "${ARG_ALL}" "${output}" "${ARG_DEPENDS}")
  # Without it, make would run the converter in several targets at once.
  foreach(needed IN LISTS ARG_ASSETS carrier)
    add_dependencies(${target} ${needed})
  endforeach()
  set_target_properties(${target} PROPERTIES
    PFVOX_OUTPUTS "${output}" PFVOX_SCENE "${scene}" PFVOX_OUTPUT_DIR "${output_dir}")
  _pfvox_remember_outputs(${target} "${output}" FALSE)
endfunction()

# What a bake with this output stands on. The models are not named: the asset targets come before the first bake, whose depfile
# names those that count. Only what a depfile cannot tell is named, in `named_inputs`, and kept out of the depfile by
# `depfile_known`. Sets `output_dir`, too: the OUTPUT_DIR of the assets that the output lies in, else its own folder.
function(_pfvox_bake_inputs output scene depfile)
  cmake_path(GET output PARENT_PATH output_dir)
  set(candidates "${scene}")
  foreach(assets IN LISTS ARG_ASSETS)
    get_target_property(outputs ${assets} PFVOX_OUTPUTS)
    list(APPEND candidates ${outputs})
    get_target_property(assets_dir ${assets} PFVOX_OUTPUT_DIR)
    cmake_path(IS_PREFIX assets_dir "${output}" NORMALIZE below)
    if(below)
      set(output_dir "${assets_dir}")
    endif()
  endforeach()
  _pfvox_untellable_characters(characters DEPFILE)
  set(named "")
  foreach(file IN LISTS candidates)
    _pfvox_first_of(character "${file}" "${characters}")
    if(character)
      list(APPEND named "${file}")
    endif()
  endforeach()
  set(depfile_known "")
  if(named)
    set(list "${depfile}.known")
    list(JOIN named "\n" lines)
    file(CONFIGURE OUTPUT "${list}" CONTENT "@lines@\n" @ONLY)
    set(depfile_known --depfile-known "${list}")
    list(APPEND named "${list}")
  endif()
  set(output_dir "${output_dir}" PARENT_SCOPE)
  set(named_inputs "${named}" PARENT_SCOPE)
  set(depfile_known "${depfile_known}" PARENT_SCOPE)
endfunction()

function(pfvox_copy_vdb_module target)
  if(NOT TARGET pfvox::vdb_module)
    message(FATAL_ERROR "pfvox_copy_vdb_module(${target}): find_package(pfvox) has to find the component tools first")
  endif()
  add_custom_command(TARGET ${target} POST_BUILD
    COMMAND ${CMAKE_COMMAND} -E copy_if_different "$<TARGET_FILE:pfvox::vdb_module>" "$<TARGET_FILE_DIR:${target}>"
    VERBATIM)
endfunction()

cmake_policy(POP)
