// Bundles and minifies scripts with what they import.
import {build} from 'esbuild';

// After minification, line breaks are in template literals, mostly shaders: removes their indentation and comment
// lines.
const plainLines = text => text.replace(/\n\s*\/\/.*/g, '').replace(/\n\s+/g, '\n');

export async function bundled(entryPoints, options) {
  const {outputFiles} = await build({
    entryPoints, bundle: true, target: 'es2022', minify: true, legalComments: 'none', absWorkingDir: new URL('.', import.meta.url).pathname,
    logLevel: 'warning', write: false, ...options});
  return outputFiles.map(({path, text}) => ({path, text: plainLines(text)}));
}
