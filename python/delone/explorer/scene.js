/* Scenes from Python for the view: reading them, and moving points one message at a time. */

import { MeshView } from "./view.js";

const KINDS = { i4: Int32Array, f8: Float64Array };

/* The mesh in a block of bytes from delone.explorer.scene, which describes its layout. */
export function unpacked(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const { arrays, ...mesh } = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  for (const [name, { kind, start, length: size }] of Object.entries(arrays)) {
    mesh[name] = new KINDS[kind](buffer, 4 + length + start, size);
  }
  return { ...mesh, vertexIds: mesh.rows, qualityRange: mesh.qualityRange || undefined };
}

/* A view of a scene. `move` sends { vertex, x, y } to Python and resolves to the new scene, or rejects
   with an error whose message says why the point cannot be there. While an answer is awaited, only the
   last position is kept. */
export function show(host, buffer, options, move) {
  const state = { mesh: unpacked(buffer), next: null, busy: false };
  const layers = state.mesh.diagram ? { triangles: false, hull: false, dual: true } : {};
  const view = new MeshView(host, {
    label: state.mesh.label,
    ...options,
    layers: { ...layers, ...options.layers },
    movable: (vertex) => vertex < state.mesh.movable, // copies of points come after all others
    onDrag: state.mesh.movable ? ({ vertex, x, y }) => follow({ vertex, x, y }) : undefined,
  });
  view.setMesh(state.mesh);

  async function follow(target) {
    state.next = target;
    if (state.busy) return;
    state.busy = true;
    while (state.next) {
      const wanted = state.next;
      state.next = null;
      try {
        state.mesh = unpacked(await move(wanted));
        if (!state.next) view.say(view.describe({ triangle: -1, vertex: wanted.vertex }));
      } catch (error) {
        view.say(error.message);
      }
      if (!state.next) view.setMesh(state.mesh, { keepView: true });
    }
    state.busy = false;
  }

  return {
    view,
    replace(other, keepView) {
      state.mesh = unpacked(other);
      view.setMesh(state.mesh, { keepView });
    },
  };
}
