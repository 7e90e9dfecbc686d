# The avatar as one classic script for pages that are embedded in a program: `Avatar` and `controlNames`, nothing else global.

set(avatar_folder ${CMAKE_CURRENT_LIST_DIR})
# Each after those it imports.
set(avatar_modules vectors palette mesh head expressions eyes mouth figure face creases shaders renderer avatar)
set(avatar_files "")
foreach(module IN LISTS avatar_modules)
  list(APPEND avatar_files ${avatar_folder}/${module}.js)
endforeach()

# Sets `result` to a module without its imports, exports, indentation and lines of comments.
function(classic_script result module)
  string(REGEX REPLACE "\nimport [^\n]* from '[^\n]*';" "" module "\n${module}")
  string(REGEX REPLACE "\nexport " "\n" module "${module}")
  string(REGEX REPLACE "\n *//[^\n]*" "" module "${module}")
  string(REGEX REPLACE "\n +" "\n" module "${module}")
  set(${result} "${module}" PARENT_SCOPE)
endfunction()

# Sets `result` to the script.
function(avatar_script result)
  set(script "")
  foreach(file IN LISTS avatar_files)
    file(READ ${file} module)
    classic_script(module "${module}")
    string(APPEND script "${module}")
  endforeach()
  set(${result} "const {Avatar, controlNames} = (() => {\n${script}\nreturn {Avatar, controlNames};\n})();\n" PARENT_SCOPE)
endfunction()
