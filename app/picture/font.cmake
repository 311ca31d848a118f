# Turns a font file into C++ source, so that the program carries it: cmake -DFONT=... -DOUT=... -P font.cmake
file(READ ${FONT} bytes HEX)
string(LENGTH "${bytes}" digits)
math(EXPR count "${digits} / 2")
string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
file(WRITE ${OUT} "extern \"C\" {
extern const unsigned char drape_font[];
extern const unsigned drape_font_bytes;
const unsigned char drape_font[] = {${bytes}};
const unsigned drape_font_bytes = ${count};
}
")
