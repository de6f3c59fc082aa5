// The page's files as they are, for assets.cpp. The include path names web/ and BUILD/web.
        .section .rodata
        .macro asset name, file
        .global \name
\name:
        .incbin "\file"
        .global \name\()_end
\name\()_end:
        .endm

        asset aircut_page_html, "page.html"
        asset aircut_page_style, "style.css"
        asset aircut_page_bundle, "libraries.js"
        asset aircut_page_script, "page.js"

        .section .note.GNU-stack, "", %progbits
