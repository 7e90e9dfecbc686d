// CPU time so far of browsers started by this program, by kind of process, in milliseconds. Linux only.
import {readFileSync, readdirSync} from 'node:fs';

const numbers = folder => readdirSync(folder).filter(name => /^\d+$/.test(name));
const parentOf = pid => {
  const text = readFileSync(`/proc/${pid}/stat`, 'utf8');
  return Number(text.slice(text.lastIndexOf(')') + 2).split(' ')[1]);
};

function isOurs(pid) {
  for (let at = Number(pid); at > 1; at = parentOf(at)) {
    if (at === process.pid) return Number(pid) !== process.pid;
  }
  return false;
}

const ofProcess = pid => numbers(`/proc/${pid}/task`).reduce((sum, thread) =>
  sum + Number(readFileSync(`/proc/${pid}/task/${thread}/schedstat`, 'utf8').split(' ')[0]) / 1e6, 0);

export function processorTime() {
  const sums = {all: 0};
  for (const pid of numbers('/proc')) {
    try {
      if (!isOurs(pid)) continue;
      const kind = /--type=([\w-]+)/.exec(readFileSync(`/proc/${pid}/cmdline`, 'utf8'))?.[1] ?? 'browser', took = ofProcess(pid);
      sums[kind] = (sums[kind] ?? 0) + took;
      sums.all += took;
    } catch {
  // the process has ended
    }
  }
  return sums;
}
