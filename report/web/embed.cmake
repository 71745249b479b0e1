# Bundles one page with esbuild and writes it as C++: cmake -DNAME=… -DESBUILD=… -DFOLDER=… -DOUT=…
# -P embed.cmake. A page is NAME.html, NAME.js with what it imports, and NAME.css.
foreach(kind js css)
  execute_process(
    COMMAND ${ESBUILD} ${FOLDER}/${NAME}.${kind} --bundle --minify --log-level=warning
      --target=es2022 --outfile=${OUT}.${kind}
    COMMAND_ERROR_IS_FATAL ANY)
  file(READ ${OUT}.${kind} ${kind})
  # The bytes between the element's tags, which the page's Content-Security-Policy allows by hash.
  string(SHA256 ${kind}_hash "${${kind}}")
endforeach()
file(READ ${FOLDER}/${NAME}.html html)
file(WRITE ${OUT} "#include \"report/web_page.h\"
namespace ergocast {
extern const WebPage k_${NAME};
const WebPage k_${NAME} = {
R\"ergocast(${html})ergocast\",
R\"ergocast(${css})ergocast\", \"${css_hash}\",
R\"ergocast(${js})ergocast\", \"${js_hash}\"};
}  // namespace ergocast
")
