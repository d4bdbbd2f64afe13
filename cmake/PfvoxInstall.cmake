# What `cmake --install` puts where. Components: tools, viewer, dev. The tree may be moved as a whole: programs find
# their module, and the CMake package its files, from where they are themselves.
include(CMakePackageConfigHelpers)

cmake_path(RELATIVE_PATH CMAKE_INSTALL_FULL_LIBDIR BASE_DIRECTORY ${CMAKE_INSTALL_PREFIX} OUTPUT_VARIABLE pfvox_libdir)
set(pfvox_cmake_dir ${CMAKE_INSTALL_LIBDIR}/cmake/pfvox)

# pfvox_install_targets(<set> COMPONENT <component> TARGETS <target>...)
# Installs targets and, as part of dev, the file from which find_package makes them again.
function(pfvox_install_targets set)
  cmake_parse_arguments(ARG "" "COMPONENT" "TARGETS" ${ARGN})
  install(TARGETS ${ARG_TARGETS} EXPORT pfvox-${set}
    RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT ${ARG_COMPONENT}
    LIBRARY DESTINATION ${PFVOX_INSTALL_MODULEDIR} COMPONENT ${ARG_COMPONENT}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${ARG_COMPONENT})
  install(EXPORT pfvox-${set} NAMESPACE pfvox:: FILE pfvox-${set}.cmake
    DESTINATION ${pfvox_cmake_dir} COMPONENT dev)
endfunction()

# One set for each component of find_package(pfvox COMPONENTS ...), for each has its own dependencies.
pfvox_install_targets(format COMPONENT dev TARGETS pfvox_format)
pfvox_install_targets(import COMPONENT dev TARGETS pfvox_import)
pfvox_install_targets(tools COMPONENT tools TARGETS vox2pf pfvox_vdb_module)
set(pfvox_archives pfvox_format pfvox_import)
set(pfvox_header_dirs libformat/include/)
if(PFVOX_BUILD_GPU)
  pfvox_install_targets(gpu COMPONENT dev TARGETS pfvox_gpu pfvox_shaders)
  pfvox_install_targets(bake COMPONENT dev TARGETS pfvox_bake)
  pfvox_install_targets(probe-bake COMPONENT tools TARGETS probe-bake)
  pfvox_install_targets(viewer COMPONENT viewer TARGETS pfview)
  list(APPEND pfvox_archives pfvox_gpu pfvox_shaders pfvox_bake)
  list(APPEND pfvox_header_dirs libbake/include/)
endif()

# CMake strips no static libraries, because a plain `strip` would take their symbols; what is meant are debug data.
if(CMAKE_STRIP)
  foreach(archive IN LISTS pfvox_archives)
    install(CODE "if(CMAKE_INSTALL_DO_STRIP)
      execute_process(COMMAND \"${CMAKE_STRIP}\" --strip-debug
        \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${pfvox_libdir}/$<TARGET_FILE_NAME:${archive}>\")
    endif()" COMPONENT dev)
  endforeach()
endif()

install(DIRECTORY ${pfvox_header_dirs} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev
  FILES_MATCHING PATTERN "*.hpp")

configure_package_config_file(cmake/pfvoxConfig.cmake.in ${PROJECT_BINARY_DIR}/cmake/pfvoxConfig.cmake
  INSTALL_DESTINATION ${pfvox_cmake_dir} PATH_VARS CMAKE_INSTALL_BINDIR NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
# Before 1.0 a new minor version may change everything.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/cmake/pfvoxConfigVersion.cmake COMPATIBILITY SameMinorVersion
  ARCH_INDEPENDENT) # the programs serve any target; pfvoxConfig.cmake looks at what the libraries are for
install(FILES
  ${PROJECT_BINARY_DIR}/cmake/pfvoxConfig.cmake
  ${PROJECT_BINARY_DIR}/cmake/pfvoxConfigVersion.cmake
  cmake/PfvoxAssets.cmake
  cmake/PfvoxAssetNames.cmake
  cmake/PfvoxAssetOutputs.cmake
  cmake/PfvoxHostTools.cmake
  DESTINATION ${pfvox_cmake_dir} COMPONENT dev)

# pkg-config: the reader library. The folders count from the file itself, so that the tree can be moved.
cmake_path(RELATIVE_PATH CMAKE_INSTALL_FULL_INCLUDEDIR BASE_DIRECTORY ${CMAKE_INSTALL_PREFIX}
  OUTPUT_VARIABLE pfvox_includedir)
cmake_path(RELATIVE_PATH CMAKE_INSTALL_PREFIX BASE_DIRECTORY ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig
  OUTPUT_VARIABLE pfvox_prefix_from_pc)
configure_file(cmake/pfvox-format.pc.in ${PROJECT_BINARY_DIR}/cmake/pfvox-format.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/cmake/pfvox-format.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT dev)

install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libpfvox-dev COMPONENT dev USE_SOURCE_PERMISSIONS
  PATTERN build EXCLUDE PATTERN generator EXCLUDE)
# As they lie in the sources, so that their links lead somewhere.
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libpfvox-dev COMPONENT dev
  FILES_MATCHING PATTERN "*.md" PATTERN "*.schema.json" REGEX "/images/[^/]+$")
