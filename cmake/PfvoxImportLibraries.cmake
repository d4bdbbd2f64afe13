# The third-party readers of pfvox::import: libzip, libspng, pugixml, OpenVDB. Included where targets link them: the
# importers and the tests that write such files.

find_package(fmt CONFIG REQUIRED)
find_package(pugixml CONFIG REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(libzip REQUIRED IMPORTED_TARGET libzip)
pkg_check_modules(spng REQUIRED IMPORTED_TARGET spng)

# OpenVDB installs a find module, not a config package, in a folder below the library folder; it is looked up in every
# prefix that CMake knows, so that no path of one distribution stands here.
find_path(PFVOX_OPENVDB_MODULE_DIR FindOpenVDB.cmake
  PATHS ${CMAKE_PREFIX_PATH} ${CMAKE_SYSTEM_PREFIX_PATH}
  PATH_SUFFIXES lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB lib/cmake/OpenVDB lib64/cmake/OpenVDB
  DOC "Folder of FindOpenVDB.cmake")
mark_as_advanced(PFVOX_OPENVDB_MODULE_DIR)
if(PFVOX_OPENVDB_MODULE_DIR)
  list(APPEND CMAKE_MODULE_PATH ${PFVOX_OPENVDB_MODULE_DIR})
endif()
# Debian's package of Imath, which OpenVDB asks for, says that it may be faulty where Python's part of it is not installed.
set(pfvox_log_level ${CMAKE_MESSAGE_LOG_LEVEL})
set(CMAKE_MESSAGE_LOG_LEVEL WARNING)
find_package(OpenVDB 10 REQUIRED COMPONENTS openvdb)
set(CMAKE_MESSAGE_LOG_LEVEL ${pfvox_log_level})

# Where OpenVDB is used, its headers and those of oneTBB become code of ours.
if(PFVOX_SANITIZE MATCHES "undefined" AND CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  set(pfvox_ignorelist ${CMAKE_CURRENT_LIST_DIR}/undefined-ignorelist.txt)
  set_property(TARGET OpenVDB::openvdb APPEND PROPERTY INTERFACE_COMPILE_OPTIONS -fsanitize-ignorelist=${pfvox_ignorelist})
endif()
