# Debian packages, one for each component: `cpack -G DEB` in a build folder that was configured with the preset
# "package" and built. Every other generator of CPack gives archives of the same components.
set(PFVOX_PACKAGE_CONTACT "pfvox authors <packages@pfvox.example>" CACHE STRING "Maintainer named in packages")

set(CPACK_PACKAGE_NAME pfvox)
set(CPACK_PACKAGE_CONTACT "${PFVOX_PACKAGE_CONTACT}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_NAME} built using CMake") # the default; any other would precede each one below
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_COMPONENTS_ALL tools dev)
if(PFVOX_BUILD_GPU)
  list(APPEND CPACK_COMPONENTS_ALL viewer)
endif()
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_ARCHIVE_COMPONENT_INSTALL ON)

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON) # of the programs and of the module that they open
set(pfvox_same_version "(= ${PROJECT_VERSION})")

set(CPACK_DEBIAN_TOOLS_PACKAGE_NAME pfvox-tools)
set(CPACK_DEBIAN_TOOLS_PACKAGE_SECTION graphics)
if(PFVOX_BUILD_GPU)
  set(CPACK_DEBIAN_TOOLS_PACKAGE_DEPENDS libvulkan1) # opened by name, so that no list of symbols tells of it
endif()
set(CPACK_DEBIAN_TOOLS_PACKAGE_RECOMMENDS "mesa-vulkan-drivers | vulkan-icd")
set(CPACK_DEBIAN_TOOLS_PACKAGE_SUGGESTS "pfvox-viewer, libpfvox-dev")
set(CPACK_COMPONENT_TOOLS_DESCRIPTION
"converter of voxel assets and baker of light-field probes
vox2pf turns MagicaVoxel, SVX and OpenVDB files into compact sparse voxel
octrees (PF_VOX) and back. probe-bake computes the indirect light of scenes
of them (PF_PROBE).")

set(CPACK_DEBIAN_VIEWER_PACKAGE_NAME pfvox-viewer)
set(CPACK_DEBIAN_VIEWER_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_VIEWER_PACKAGE_RECOMMENDS "mesa-vulkan-drivers | vulkan-icd")
set(CPACK_DEBIAN_VIEWER_PACKAGE_SUGGESTS "pfvox-tools")
set(CPACK_COMPONENT_VIEWER_DESCRIPTION
"viewer of voxel octrees and their scenes
pfview shows PF_VOX files and scenes of them in a window, or writes pictures
without one.")

set(CPACK_DEBIAN_DEV_PACKAGE_NAME libpfvox-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_SHLIBDEPS OFF) # static libraries only: what they are linked with is listed here
string(JOIN ", " CPACK_DEBIAN_DEV_PACKAGE_DEPENDS
  "pfvox-tools ${pfvox_same_version}" pkg-config
  libexpected-dev libglm-dev libtbb-dev libfmt-dev libtomlplusplus-dev libzstd-dev libxxhash-dev
  libpugixml-dev libzip-dev libspng-dev)
if(PFVOX_BUILD_GPU)
  string(APPEND CPACK_DEBIAN_DEV_PACKAGE_DEPENDS ", libvulkan-dev")
endif()
set(CPACK_DEBIAN_DEV_PACKAGE_SUGGESTS "pfvox-viewer, cmake (>= 3.25)")
set(CPACK_COMPONENT_DEV_DESCRIPTION
"libraries of pfvox, and its CMake functions for asset builds
Headers and static libraries that read, build, trace and bake sparse voxel
octrees; a CMake package with pfvox_add_assets() and pfvox_add_probe_bake(),
which make voxel assets and their light parts of a build; examples.")

include(PfvoxPackageNotes)
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER ${component} upper)
  pfvox_install_notes(${component} ${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
endforeach()

include(CPack)
