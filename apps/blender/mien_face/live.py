"""The running receiver: at most one for all scenes."""

import time

import bpy
from bpy.app.handlers import persistent

from . import actions, targets
from .frame import FaceDataError
from .receiver import ANY, LOOPBACK, Receiver
from .recording import Recording

_INTERVAL_S = 1.0 / 120.0  # between reads of the socket
_REDRAW_S = 0.25  # between updates of the panel


class _Session:
    def __init__(self, scene):
        settings = scene.mien_face
        host = ANY if settings.from_network else LOOPBACK
        self.receiver = Receiver(settings.port, host, settings.llf_rotation)
        self.scene_uid = scene.session_uid
        self.problem = ""
        self.recording = None
        self.recording_frame = 0
        self.redrawn_s = 0.0

    def scene(self):
        return next((scene for scene in bpy.data.scenes if scene.session_uid == self.scene_uid), None)

    def tick(self, scene):
        now_s = time.monotonic()
        frames = self.receiver.poll()
        if self.recording is not None:
            for frame in frames:
                self.recording.add(frame, now_s)
        if frames and not bpy.app.is_job_running("RENDER"):
            self.show(scene.mien_face, frames[-1])
        if now_s - self.redrawn_s > _REDRAW_S:
            self.redrawn_s = now_s
            _redraw()

    def show(self, settings, frame):
        try:
            targets.apply(settings, frame)
            self.problem = ""
        except FaceDataError as error:
            self.problem = str(error)


_session = None
_ended = ""  # why the last session ended by itself


def running():
    return _session is not None


def recording():
    return _session is not None and _session.recording is not None


def start(scene):
    """Raises FaceDataError if the port cannot be opened."""
    global _session, _ended
    stop()
    _session, _ended = _Session(scene), ""
    bpy.app.timers.register(tick, first_interval=0.0)


def stop(reason=""):
    global _session, _ended
    if _session is None:
        return
    _session.receiver.close()
    _session, _ended = None, reason
    if bpy.app.timers.is_registered(tick):
        bpy.app.timers.unregister(tick)
    _redraw()


def tick():
    """Called by Blender's timer; returns the seconds until the next call, None to end."""
    if _session is None:
        return None
    scene = _session.scene()
    if scene is None:
        stop("the scene was deleted")
        return None
    try:
        _session.tick(scene)
    except Exception as error:  # Blender drops a timer that raises; the socket must not stay open then
        stop(f"internal error: {error}")
        raise
    return _INTERVAL_S


def start_recording(scene):
    _session.recording = Recording(time.monotonic())
    _session.recording_frame = scene.frame_current


def stop_recording(scene):
    """Writes the recorded frames as actions. Raises FaceDataError without frames, or without anything to animate."""
    recorded, start_frame = _session.recording, _session.recording_frame
    _session.recording = None
    if not len(recorded):
        raise FaceDataError("no frames arrived during the recording")
    per_second = scene.render.fps / scene.render.fps_base
    return actions.write(scene.mien_face, recorded.frames(), lambda t: start_frame + t * per_second, "recording", False)


def status():
    """Lines for the panel: (text, whether it is a problem)."""
    if _session is None:
        return [(f"Stopped: {_ended}", True)] if _ended else []
    receiver = _session.receiver
    lines = [(f"Port {receiver.port}: {receiver.frames} frames", False)]
    if _session.recording is not None:
        full = ", full" if _session.recording.full else ""
        lines.append((f"Recording: {len(_session.recording)} frames{full}", bool(full)))
    if receiver.errors:
        lines.append((f"{receiver.errors} packets rejected: {receiver.last_error}", True))
    return lines + ([(_session.problem, True)] if _session.problem else [])


def _redraw():
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


@persistent
def _before_load(*_):
    stop()


def register():
    bpy.app.handlers.load_pre.append(_before_load)


def unregister():
    stop()
    bpy.app.handlers.load_pre.remove(_before_load)
