# Compiler settings of every pfvox target: warnings, sanitizers, coverage.
# Use: pfvox_compile_options(<target>)

function(pfvox_compile_options target)
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wold-style-cast
    -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-qual -Wundef
    -Wno-missing-field-initializers # naming some fields and leaving the others to their defaults is our style
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>) # GCC 12 warns falsely about string + literal at -O3 (GCC bug 105651)
  if(PFVOX_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  # Assertions (PFVOX_ASSERT) are on everywhere but in release builds.
  target_compile_definitions(${target} PRIVATE
    $<$<NOT:$<CONFIG:Release,MinSizeRel>>:PFVOX_ENABLE_ASSERTIONS>)
endfunction()

if(PFVOX_SANITIZE)
  string(REPLACE "," ";" _pfvox_sanitizers "${PFVOX_SANITIZE}")
  foreach(_s IN LISTS _pfvox_sanitizers)
    add_compile_options(-fsanitize=${_s})
    add_link_options(-fsanitize=${_s})
  endforeach()
  add_compile_options(-fno-omit-frame-pointer -fno-sanitize-recover=all)
endif()
