# Manual pages and shell completions: each program writes its own, from the options that its --help lists.
#
#   quincunx_manuals(TARGET...)    makes them with the programs, and installs them
function(quincunx_manuals)
  set(folder ${PROJECT_BINARY_DIR}/manuals)
  file(MAKE_DIRECTORY ${folder})
  set(made "")
  foreach(program ${ARGN})
    set(page ${folder}/${program}.1)
    set(bash ${folder}/${program}.bash)
    set(zsh ${folder}/_${program})
    set(fish ${folder}/${program}.fish)
    add_custom_command(
      OUTPUT ${page}.gz ${bash} ${zsh} ${fish}
      COMMAND ${program} --manual man > ${page}
      COMMAND gzip -9nf ${page}
      COMMAND ${program} --manual bash > ${bash}
      COMMAND ${program} --manual zsh > ${zsh}
      COMMAND ${program} --manual fish > ${fish}
      DEPENDS ${program}
      COMMENT "Writing the manual of ${program}"
      VERBATIM)
    list(APPEND made ${page}.gz)
    install(FILES ${page}.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT tools)
    install(FILES ${bash} DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME ${program}
            COMPONENT tools)
    install(FILES ${zsh} DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT tools)
    install(FILES ${fish} DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT tools)
  endforeach()
  add_custom_target(quincunx_manuals ALL DEPENDS ${made})
endfunction()
