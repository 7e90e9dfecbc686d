// The blind vote. A random draw assigns files to sides when the page opens. The sides are hidden
// until the vote ends; afterwards votes cannot change.

const groups = [
  ...controlGroups,
  {key: 'head', title: 'Head', hint: 'turning, nodding, tilting', of: null},
  {key: 'overall', title: 'Overall', hint: 'the face as a whole: likeness, timing, steadiness', of: /./},
];

const drawLots = () => (crypto.getRandomValues(new Uint8Array(1))[0] & 1 ? ['a', 'b'] : ['b', 'a']);

// Groups that neither file animates have no vote.
function isAnimated(group) {
  return [data.a, data.b].some(file => group.of === null ? hasHead(file) :
    data.controls.some(name => group.of.test(name) && drives(file, name)));
}

class Study {
  constructor(onReveal) {
    [this.left, this.right] = drawLots();
    this.onReveal = onReveal;
    this.votes = {};  // group: 'left', 'same' or 'right'
    this.open = true;
    this.groups = groups.filter(isAnimated);
    document.getElementById('votes').append(...this.groups.map(group => this.row(group)));
    document.getElementById('export').addEventListener('click', () => this.export());
    document.getElementById('reveal').addEventListener('click', () => this.reveal());
  }

  fileOn(side) { return data[side === 'left' ? this.left : this.right]; }

  row(group) {
    const row = document.createElement('div');
    row.className = 'vote';
    row.innerHTML = `<div class="what"><b>${group.title}</b><span>${group.hint}</span></div><div class="choices"></div>`;
    const choices = {left: 'left better', same: 'same', right: 'right better'};
    for (const [choice, text] of Object.entries(choices)) {
      const button = document.createElement('button');
      Object.assign(button, {type: 'button', textContent: text});
      Object.assign(button.dataset, {group: group.key, choice});
      button.setAttribute('aria-pressed', 'false');
      button.addEventListener('click', () => this.vote(group.key, choice));
      row.lastChild.append(button);
    }
    return row;
  }

  // A second click removes a vote.
  vote(key, choice) {
    if (this.votes[key] === choice) delete this.votes[key]; else this.votes[key] = choice;
    for (const button of document.querySelectorAll(`[data-group="${key}"]`)) {
      button.setAttribute('aria-pressed', String(this.votes[key] === button.dataset.choice));
    }
  }

  // docs/cli.md describes these fields.
  result() {
    const names = {left: this.left.toUpperCase(), right: this.right.toUpperCase(), same: 'same'};
    const voted = this.groups.filter(group => group.key in this.votes);
    return {
      mien_compare: 1, a: data.a.name, b: data.b.name, left: names.left,
      participant: document.getElementById('participant').value.trim(),
      exported_at: new Date().toISOString(),
      groups: this.groups.map(group => group.key),
      votes: Object.fromEntries(voted.map(group => [group.key, names[this.votes[group.key]]])),
    };
  }

  export() {
    const result = this.result();
    const link = document.createElement('a');
    link.href = URL.createObjectURL(new Blob([JSON.stringify(result, null, 1) + '\n'], {type: 'application/json'}));
    link.download = `votes-${result.exported_at.replace(/[^0-9]/g, '').slice(0, 14)}.json`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 60000);
    this.reveal();
  }

  reveal() {
    if (!this.open) return;
    this.open = false;
    for (const button of document.querySelectorAll('#votes button')) button.disabled = true;
    document.getElementById('reveal').hidden = true;
    const missing = this.groups.length - Object.keys(this.votes).length;
    document.getElementById('study-note').textContent = 'The vote is over' +
      (missing ? `; ${missing} of ${this.groups.length} have no vote.` : '.');
    for (const side of ['left', 'right']) {
      const caption = document.getElementById(`caption-${side}`);
      caption.textContent = `${side}: ${this[side].toUpperCase()}, ${this.fileOn(side).name}`;
      caption.className = this[side];
    }
    this.onReveal();
  }
}
