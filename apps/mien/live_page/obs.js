// The avatar alone.
const avatar = new AvatarView(document.getElementById('face'));
listen({onFrame: frame => avatar.show(frame)});
