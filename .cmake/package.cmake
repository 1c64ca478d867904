# cmake --install BUILD --component program, and the packages of cpack: Debian's and an archive.
include(GNUInstallDirs)

install(TARGETS vkcppm RUNTIME COMPONENT program)
install(FILES ${manual}/vkcppm.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES ${manual}/vkcppm.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
        RENAME vkcppm COMPONENT program)
install(FILES ${manual}/_vkcppm DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions COMPONENT program)
install(FILES ${manual}/vkcppm.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d
        COMPONENT program)
install(FILES LICENSE README.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)

set(CPACK_GENERATOR DEB TGZ)
set(CPACK_INSTALL_CMAKE_PROJECTS "${CMAKE_BINARY_DIR};${PROJECT_NAME};program;/")
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR})
set(CPACK_SYSTEM_NAME ${CMAKE_SYSTEM_NAME}-${CMAKE_SYSTEM_PROCESSOR})
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_VENDOR "The authors of vkcppm")
set(CPACK_PACKAGE_CONTACT "${CPACK_PACKAGE_VENDOR} <vkcppm@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_DESCRIPTION "Renders glTF scenes without a window by progressive photon mapping, whose estimators
it races against each other, on any Vulkan device; the processor counts, by lavapipe.")
set(CPACK_PACKAGE_CHECKSUM SHA256)
set(CPACK_RESOURCE_FILE_LICENSE ${CMAKE_CURRENT_SOURCE_DIR}/LICENSE)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_DEPENDS libvulkan1)  # opened by name while the program runs
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)        # and what it is linked to, by dpkg-shlibdeps of dpkg-dev
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS mesa-vulkan-drivers)
# Before a package is made of what was installed.
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/debian.cmake)

include(CPack)
