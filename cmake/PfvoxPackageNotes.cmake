# What every Debian package says about itself below share/doc: its licence with those of the code that was compiled into it,
# and its changelog.

# The licences of code that ends up in our binaries, by the Debian packages that it comes from; those of shared libraries come
# with their own packages.
set(pfvox_notices_tools libcli11-dev nlohmann-json3-dev libglm-dev libopenvdb-dev)
set(pfvox_notices_viewer libcli11-dev nlohmann-json3-dev libglm-dev libimgui-dev)
set(pfvox_notices_dev libglm-dev)

function(pfvox_write_copyright file component)
  file(READ ${PROJECT_SOURCE_DIR}/LICENSE text)
  foreach(library IN LISTS pfvox_notices_${component})
    set(notice /usr/share/doc/${library}/copyright)
    if(EXISTS ${notice})
      file(READ ${notice} licence)
      string(APPEND text "\n\nThis package contains code of ${library}, under these terms:\n\n${licence}")
    endif()
  endforeach()
  file(CONFIGURE OUTPUT ${file} CONTENT "@text@" @ONLY)
endfunction()

# In Debian's form, which dpkg and apt show; CHANGELOG.md beside it tells what changed. SOURCE_DATE_EPOCH makes its date that of
# the sources.
function(pfvox_write_changelog file package)
  string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
  file(WRITE ${file} "${package} (${PROJECT_VERSION}) unstable; urgency=medium

  * Version ${PROJECT_VERSION}: see CHANGELOG.md in this folder.

 -- ${PFVOX_PACKAGE_CONTACT}  ${date}
")
  execute_process(COMMAND ${PFVOX_GZIP} -9nf ${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# pfvox_install_notes(<component> <package>)
function(pfvox_install_notes component package)
  set(folder ${PROJECT_BINARY_DIR}/package-notes/${package})
  pfvox_write_copyright(${folder}/copyright ${component})
  set(notes ${folder}/copyright ${PROJECT_SOURCE_DIR}/CHANGELOG.md)
  if(PFVOX_GZIP)
    pfvox_write_changelog(${folder}/changelog ${package})
    list(APPEND notes ${folder}/changelog.gz)
  endif()
  install(FILES ${notes} DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${component})
endfunction()
