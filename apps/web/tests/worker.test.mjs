// Tests the worker in Node, with frames that record when they are read. MIEN_WASM names the module.
import assert from 'node:assert/strict';
import {EventEmitter, once} from 'node:events';
import {copyFileSync, mkdtempSync, readFileSync, rmSync, symlinkSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {after, test} from 'node:test';
import {setTimeout as pass} from 'node:timers/promises';
import {pathToFileURL} from 'node:url';

const root = new URL('../../../', import.meta.url).pathname, folder = mkdtempSync(join(tmpdir(), 'mien-'));
copyFileSync(process.env.MIEN_WASM ?? `${root}build/wasm/tracker/mien.wasm`, join(folder, 'mien.wasm'));
symlinkSync(`${root}models`, join(folder, 'models'));
after(() => rmSync(folder, {recursive: true}));

globalThis.fetch = async url => new Response(readFileSync(url));
const heard = new EventEmitter(), happened = [];
globalThis.onmessage = null;
globalThis.postMessage = message => heard.emit(message.type, message);
heard.on('results', ({timeMs}) => happened.push(`results ${timeMs}`));
await import('../src/tracking/worker.js');
const post = data => globalThis.onmessage({data});

const picture = (name, readMs, side) => ({
  [Symbol.toStringTag]: 'VideoFrame', format: 'RGBA', displayWidth: side, displayHeight: side, visibleRect: {width: side, height: side}, allocationSize: () => 4 * side * side,
  async copyTo(memory) {
    happened.push(`reads ${name}`);
    await pass(readMs);
    memory.fill(100);
    return [{offset: 0, stride: 4 * side}];
  },
  close() { happened.push(`closes ${name}`); }});

test('requests wait until the tracker is loaded', async () => {
  const ready = once(heard, 'ready');
  post({type: 'load', folder: pathToFileURL(folder).href});
  post({type: 'levels', levels: [1]});
  await ready;
  const results = once(heard, 'results');
  post({type: 'advance', timeMs: 0});
  const [{results: [{lod}]}] = await results;
  assert.equal(lod, 1);
});

test('an image is read after the previous one was tracked', async () => {
  happened.length = 0;
  post({type: 'frame', frame: picture('slow', 50, 64), timeMs: 100});
  post({type: 'frame', frame: picture('quick', 0, 96), timeMs: 133});
  post({type: 'advance', timeMs: 166});
  while (happened.filter(what => what.startsWith('results')).length < 3) await pass(5);
  assert.deepEqual(happened, ['reads slow', 'closes slow', 'results 100', 'reads quick', 'closes quick', 'results 133', 'results 166']);
});
