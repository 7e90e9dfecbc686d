// A switch per destination.

class Senders {
  constructor(list, note) { Object.assign(this, {list, note}); }

  show(senders) {
    if (this.list.childElementCount !== senders.length) this.list.replaceChildren(...senders.map((_, i) => this.item(i)));
    this.note.hidden = senders.length > 0;
    senders.forEach(({name, detail, paused}, i) => {
      const [box, text] = this.list.children[i].firstElementChild.children;
      box.checked = !paused;
      text.firstChild.textContent = name + ' ';
      text.lastChild.textContent = paused ? 'paused' : detail;
    });
  }

  item(i) {
    const item = document.createElement('li'), label = document.createElement('label');
    const box = document.createElement('input'), text = document.createElement('span');
    Object.assign(box, {type: 'checkbox', role: 'switch'});
    box.addEventListener('change', () => command('sender', {sender: i, paused: !box.checked}).catch(error => complain(error.message)));
    text.append('', document.createElement('small'));
    text.prepend(document.createTextNode(''));
    label.append(box, text);
    item.append(label);
    return item;
  }
}
