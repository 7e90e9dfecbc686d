# The manual page and the completions of shells, which the program prints. A program for another machine cannot.
if(CMAKE_CROSSCOMPILING)
  return()
endif()
set(texts_dir ${CMAKE_CURRENT_BINARY_DIR}/texts)
file(MAKE_DIRECTORY ${texts_dir})
set(zsh_dir ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr" AND EXISTS /etc/debian_version)
  set(zsh_dir ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)  # where Debian's zsh looks
endif()

set(texts)
function(mien_install_text name folder)  # arguments of the program
  set(file ${texts_dir}/${name})
  add_custom_command(OUTPUT ${file} COMMAND mien_program ${ARGN} > ${file} DEPENDS mien_program VERBATIM)
  install(FILES ${file} DESTINATION ${folder} OPTIONAL)  # if only some targets were built
  set(texts ${texts} ${file} PARENT_SCOPE)
endfunction()
mien_install_text(mien.1 ${CMAKE_INSTALL_MANDIR}/man1 manual)
mien_install_text(mien ${CMAKE_INSTALL_DATADIR}/bash-completion/completions completion bash)
mien_install_text(_mien ${zsh_dir} completion zsh)
mien_install_text(mien.fish ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d completion fish)
add_custom_target(mien_texts ALL DEPENDS ${texts})
