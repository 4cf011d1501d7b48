# Warnings and sanitizers of every target of the project.
add_library(quincunx_options INTERFACE)
target_compile_options(quincunx_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
                       -Wno-sign-conversion -Wnon-virtual-dtor)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # False alarms inside of std::string, more of them where headers are precompiled (GCC bug 105651 and its kind).
  target_compile_options(quincunx_options INTERFACE -Wno-array-bounds -Wno-stringop-overflow)
  if(CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(quincunx_options INTERFACE -Wno-restrict)
  endif()
endif()
# False alarms where files are compiled several at once; the builds of single files still look.
set(alarms -Wno-shadow)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  list(APPEND alarms -Wno-subobject-linkage)
endif()
target_compile_options(quincunx_options INTERFACE "$<$<BOOL:$<TARGET_PROPERTY:UNITY_BUILD>>:${alarms}>")
if(QUINCUNX_WERROR)
  target_compile_options(quincunx_options INTERFACE -Werror)
endif()
if(QUINCUNX_SANITIZE)
  add_compile_options(-fsanitize=${QUINCUNX_SANITIZE} -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${QUINCUNX_SANITIZE})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # False alarms in <regex>, which GCC's manual announces for code that sanitizers have changed.
    add_compile_options(-Wno-maybe-uninitialized)
  endif()
endif()
