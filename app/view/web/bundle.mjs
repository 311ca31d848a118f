// Makes the page of `drape view` and puts it into a C++ source.
//   node bundle.mjs PAGE.cpp      beside node_modules; PAGE.cpp: viewer_page in pieces, for compilers bound the length of a text
import { build } from "esbuild";
import { readFileSync, readdirSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url)), [, , out] = process.argv;

async function bundled(entry, extra = {}) {
  const result = await build({
    entryPoints: [join(here, entry)], bundle: true, minify: true, write: false, target: "es2022", legalComments: "none", ...extra,
  });
  return result.outputFiles[0].text.trim();
}

// What the licences of the bundled packages ask for: their texts go with them.
function licences() {
  const { packages } = JSON.parse(readFileSync(join(here, "package-lock.json"), "utf8"));
  const bundled = Object.entries(packages).filter(([path, about]) => path !== "" && !about.dev && !about.optional);
  return bundled.map(([path, { version }]) => {
    const file = readdirSync(join(here, path)).find((name) => /^licen[sc]e/i.test(name));
    const text = readFileSync(join(here, path, file), "utf8").trim();
    return `/*! ${path.replace("node_modules/", "")} ${version}\n${text.replaceAll("*/", "* /")} */\n`;
  }).join("");
}

const script = licences() + (await bundled("src/main.js", { format: "iife" })), style = await bundled("page.css");
if (/<\/script|<!--/i.test(script)) throw new Error("the script would end itself");
const page = readFileSync(join(here, "page.html"), "utf8").replace("@@STYLE@@", () => style).replace("@@SCRIPT@@", () => script);

const mark = "drape_page", pieces = [];
if (page.includes(`)${mark}"`)) throw new Error("the page has the mark that ends it");
const characters = [...page];
for (let i = 0; i < characters.length; i += 8000) pieces.push(`R"${mark}(${characters.slice(i, i + 8000).join("")})${mark}"`);
writeFileSync(out, `// Made by app/view/web/bundle.mjs.\n#include "app/view/page_template.h"\n\nnamespace drape {\n
std::string_view page_template() {\n  static constexpr char page[] =\n${pieces.join("\n")};\n  return {page, sizeof page - 1};\n}\n
}  // namespace drape\n`);
