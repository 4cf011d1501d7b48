# Manual pages, made by help2man from what --help-all says, and shell completions, which each program writes itself.
# Without help2man there are completions only.
#
#   quincunx_manuals(TARGET...)    makes them with the programs, and installs them
find_program(QUINCUNX_HELP2MAN help2man)
if(NOT QUINCUNX_HELP2MAN)
  message(STATUS "help2man not found; the programs get no manual pages")
endif()
set(quincunx_render_name "draw scenes at a dynamic resolution and make full pictures")
set(quincunx_dump_name "show every stage of a frame, or write a run as a sequence")
set(quincunx_resolve_name "make full-size frames from an EXR sequence of any renderer")
set(quincunx_bench_name "measure speed against error of every method")

function(quincunx_manuals)
  set(folder ${PROJECT_BINARY_DIR}/manuals)
  set(more ${folder}/more.h2m)
  file(WRITE ${more} "[FILES]\n.TP\n\\fI~/.cache/quincunx\\fR\nCompiled kernels. The environment variable QUINCUNX_CACHE_DIR \
names another folder, or none if it is empty.\n[>SEE ALSO]\n")
  foreach(program ${ARGN})
    file(APPEND ${more} "\\fB${program}\\fR(1)\n")
  endforeach()
  set(made "")
  foreach(program ${ARGN})
    set(page ${folder}/${program}.1)
    set(shells ${folder}/${program}.bash ${folder}/_${program} ${folder}/${program}.fish)
    add_custom_command(
      OUTPUT ${shells}
      COMMAND ${program} --completion bash > ${folder}/${program}.bash
      COMMAND ${program} --completion zsh > ${folder}/_${program}
      COMMAND ${program} --completion fish > ${folder}/${program}.fish
      DEPENDS ${program}
      COMMENT "Writing the completions of ${program}"
      VERBATIM)
    list(APPEND made ${shells})
    install(FILES ${folder}/${program}.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME ${program}
            COMPONENT tools)
    install(FILES ${folder}/_${program} DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT tools)
    install(FILES ${folder}/${program}.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT tools)
    if(QUINCUNX_HELP2MAN)
      string(REPLACE "-" "_" variable ${program})
      add_custom_command(
        OUTPUT ${page}.gz
        COMMAND ${QUINCUNX_HELP2MAN} --no-info --help-option=--help-all --name=${${variable}_name} --include=${more}
                --output=${page} $<TARGET_FILE:${program}>
        COMMAND gzip -9nf ${page}
        DEPENDS ${program} ${more}
        COMMENT "Writing the manual page of ${program}"
        VERBATIM)
      list(APPEND made ${page}.gz)
      install(FILES ${page}.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT tools)
    endif()
  endforeach()
  add_custom_target(quincunx_manuals ALL DEPENDS ${made})
endfunction()
