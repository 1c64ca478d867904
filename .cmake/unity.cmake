# Several files as one for the compiler (CMAKE_UNITY_BUILD, which the presets release and ci turn on): what they include
# is then read once, and a build takes little more than half the time. Names in their unnamed namespaces must differ; a
# file whose options are its own stays apart.

# unite_folders(<target>): the files of a folder are one.
function(unite_folders target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "\\.cpp$")
  foreach(source IN LISTS sources)
    cmake_path(ABSOLUTE_PATH source OUTPUT_VARIABLE path)
    cmake_path(RELATIVE_PATH path BASE_DIRECTORY ${PROJECT_SOURCE_DIR})
    cmake_path(GET path PARENT_PATH folder)
    string(MAKE_C_IDENTIFIER "${folder}" group)
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group})
  endforeach()
endfunction()

# unite_alphabet(<target>): the files whose names begin in the same quarter of the alphabet are one, so that a file that
# is added moves no other.
function(unite_alphabet target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    cmake_path(GET source FILENAME name)
    foreach(quarter a-f g-l m-r s-z)
      if(name MATCHES "^[${quarter}]")
        set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${quarter})
      endif()
    endforeach()
  endforeach()
endfunction()
