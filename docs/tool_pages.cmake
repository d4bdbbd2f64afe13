# cmake -D TOOL=<program> -D MAN=<file> -D BASH=<file> -D ZSH=<file> -D FISH=<file> -P tool_pages.cmake
# Has the program write its man page and completions.
foreach(kind man bash zsh fish)
  string(TOUPPER ${kind} name)
  cmake_path(GET ${name} PARENT_PATH folder)
  file(MAKE_DIRECTORY ${folder})
  execute_process(COMMAND ${TOOL} --generate ${kind} OUTPUT_FILE ${${name}} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
