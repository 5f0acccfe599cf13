// Wires as capsules: one quad per bond, the surface found per pixel (orthographic rays along -z of the view).

struct View {
  rotation: mat3x3<f32>,
  centre: vec4<f32>,   // xyz [mm]
  scale: vec4<f32>,    // x, y: view mm -> clip; z: half depth [mm]; w: size of a pixel [mm]
  rim: vec4<f32>,      // rgb: light added along silhouettes; w: darkening along silhouettes
  fade: vec4<f32>,     // x: depth of the axis in view [mm], y: radius over which depth darkens [mm]
  signal: vec4<f32>,   // colour of broken ends, linear
};
@group(0) @binding(0) var<uniform> view: View;

struct Segment {
  @location(0) a: vec4<f32>,   // first centre, radius [mm]
  @location(1) b: vec4<f32>,   // second centre, radius [mm]
  @location(2) ta: vec4<f32>,  // tangent of the wire at a; w: 0 joint, 1 end, 2 broken end
  @location(3) tb: vec4<f32>,
  @location(4) ca: vec4<f32>,  // linear colour at a; w: shade of wires inside the strand
  @location(5) cb: vec4<f32>,
  @location(6) oa: vec4<f32>,  // occlusion at a: sum of w d, sum of w
  @location(7) ob: vec4<f32>,
};

struct Varying {
  @builtin(position) clip: vec4<f32>,
  @location(0) p: vec2<f32>,
  @location(1) @interpolate(flat) a: vec4<f32>,
  @location(2) @interpolate(flat) b: vec4<f32>,
  @location(3) @interpolate(flat) ta: vec4<f32>,
  @location(4) @interpolate(flat) tb: vec4<f32>,
  @location(5) @interpolate(flat) ca: vec4<f32>,
  @location(6) @interpolate(flat) cb: vec4<f32>,
  @location(7) @interpolate(flat) oa: vec4<f32>,
  @location(8) @interpolate(flat) ob: vec4<f32>,
};

// How far the quad must reach beyond a centre: the full radius at an end; at a joint only what the bend opens.
fn reach(kind: f32, r: f32, tangent: vec3<f32>, along: vec3<f32>) -> f32 {
  let c = max(dot(tangent, along), 0.1);
  let bend = sqrt(max(1.0 - c * c, 0.0)) / c;
  let joint = r * min(bend + abs(along.z) + 0.05, 1.0);
  return select(joint, r, kind > 0.5);
}

@vertex fn vs(@builtin(vertex_index) vertex: u32, in: Segment) -> Varying {
  var o: Varying;
  o.a = vec4<f32>(view.rotation * (in.a.xyz - view.centre.xyz), in.a.w);
  o.b = vec4<f32>(view.rotation * (in.b.xyz - view.centre.xyz), in.b.w);
  o.ta = vec4<f32>(view.rotation * in.ta.xyz, in.ta.w);
  o.tb = vec4<f32>(view.rotation * in.tb.xyz, in.tb.w);
  o.ca = in.ca;
  o.cb = in.cb;
  o.oa = vec4<f32>(view.rotation * in.oa.xyz, in.oa.w);
  o.ob = vec4<f32>(view.rotation * in.ob.xyz, in.ob.w);

  let d = o.b.xyz - o.a.xyz;
  let length3 = length(d);
  let length2 = length(d.xy);
  let pixel = view.scale.w;
  let along = select(vec3<f32>(1.0, 0.0, 0.0), d / length3, length3 > 1e-9);
  let right = select(vec2<f32>(1.0, 0.0), d.xy / length2, length2 > 1e-9);
  let up = vec2<f32>(-right.y, right.x);
  let before = reach(in.ta.w, in.a.w, o.ta.xyz, along) + pixel;
  let after = reach(in.tb.w, in.b.w, o.tb.xyz, along) + pixel;
  let half = max(in.a.w, in.b.w) + pixel;
  let first = (vertex & 1u) == 0u;
  let side = select(-1.0, 1.0, (vertex >> 1u) == 1u);
  let end = select(o.b.xy + right * after, o.a.xy - right * before, first);
  o.p = end + up * (half * side);
  o.clip = vec4<f32>(o.p * view.scale.xy, 0.5, 1.0);
  return o;
}

// Whether p lies inside the segment's outline in the picture. `along` is the axis over its squared length.
fn covers(p: vec2<f32>, a: vec4<f32>, b: vec4<f32>, along: vec2<f32>) -> bool {
  let w = p - a.xy;
  let s = clamp(dot(w, along), 0.0, 1.0);
  let off = w - (b.xy - a.xy) * s;
  let r = mix(a.w, b.w, s);
  return dot(off, off) <= r * r;
}

fn outline_axis(in: Varying) -> vec2<f32> {
  let d = in.b.xy - in.a.xy;
  return d / max(dot(d, d), 1e-12);
}

struct Hit {
  z: f32,
  s: f32,             // along the axis, 0 to 1
  from_axis: vec3<f32>,
};

// Front-most point over p: the cone between the two spheres, or one of the spheres.
fn intersect(p: vec2<f32>, a: vec4<f32>, b: vec4<f32>) -> Hit {
  let axis = b.xyz - a.xyz;
  let l = length(axis);
  var hit: Hit;
  hit.z = -1e30;
  hit.s = 0.0;
  let wa = p - a.xy;
  let ha = a.w * a.w - dot(wa, wa);
  let wb = p - b.xy;
  let hb = b.w * b.w - dot(wb, wb);
  // The nearest thing to a hit, for pixels whose centre just misses the outline.
  let za = a.z + sqrt(max(ha, 0.0));
  let zb = b.z + sqrt(max(hb, 0.0));
  if (ha > 0.0 || l < 1e-9) { hit.z = za; hit.s = 0.0; }
  if (hb > 0.0 && zb > hit.z) { hit.z = zb; hit.s = 1.0; }
  if (l > 1e-9) {
    // |w|^2 - (w.d)^2 = (ra + k w.d)^2 with w = (p, a.z + t) - a, solved for the greater t.
    let d = axis / l;
    let k = (b.w - a.w) / l;
    let m = dot(wa, d.xy);
    let rm = a.w + k * m;
    let qa = 1.0 - d.z * d.z * (1.0 + k * k);
    let qb = -d.z * (m + k * rm);
    let qc = dot(wa, wa) - m * m - rm * rm;
    let disc = qb * qb - qa * qc;
    if (disc > 0.0 && qa > 1e-6) {
      let t = (-qb + sqrt(disc)) / qa;
      let s = (m + t * d.z) / l;
      if (s >= 0.0 && s <= 1.0 && a.z + t > hit.z) { hit.z = a.z + t; hit.s = s; }
    }
    if (hit.z < -1e29) {
      hit.s = clamp(m / l, 0.0, 1.0);
      hit.z = mix(a.z, b.z, hit.s);
    }
  }
  hit.from_axis = vec3<f32>(p, hit.z) - mix(a.xyz, b.xyz, hit.s);
  return hit;
}

fn square(x: f32) -> f32 { return x * x; }

struct Lit { colour: vec4<f32>, depth: f32, };

fn shade(p: vec2<f32>, in: Varying) -> Lit {
  let hit = intersect(p, in.a, in.b);
  let s = hit.s;
  // Normals turn steadily along the wire: what lies along the wire's own tangent is taken out, except on end caps.
  let axis = in.b.xyz - in.a.xyz;
  let behind = dot(vec3<f32>(p, hit.z) - in.a.xyz, axis) < 0.0;
  let beyond = dot(vec3<f32>(p, hit.z) - in.b.xyz, axis) > 0.0;
  let lone = dot(axis, axis) < 1e-12;
  let cap = lone || (behind && in.ta.w > 0.5) || (beyond && in.tb.w > 0.5);
  let tangent = normalize(mix(in.ta.xyz, in.tb.xyz, s) + vec3<f32>(0.0, 0.0, 1e-9));
  let radial = hit.from_axis - tangent * dot(hit.from_axis, tangent);
  let n = normalize(select(radial, hit.from_axis, cap) + vec3<f32>(0.0, 0.0, 1e-6));

  // Broken ends: a band of the signal colour before the cap, and the cap.
  let r = mix(in.a.w, in.b.w, s);
  let l = length(axis);
  let band = 0.5 * r;
  let soft = 0.5 * view.scale.w;
  let from_a = select(s * l, 0.0, behind);
  let from_b = select((1.0 - s) * l, 0.0, beyond);
  var broken = 0.0;
  if (in.ta.w > 1.5) { broken = max(broken, 1.0 - smoothstep(band - soft, band + soft, from_a)); }
  if (in.tb.w > 1.5) { broken = max(broken, 1.0 - smoothstep(band - soft, band + soft, from_b)); }
  let base = mix(mix(in.ca.rgb, in.cb.rgb, s), view.signal.rgb, broken);

  let o = mix(in.oa, in.ob, s);
  // Neighbours on both sides cancel in the sum of directions; what is left of the sum of weights lies to the sides.
  let sides = max(o.w - length(o.xyz), 0.0);
  let lateral = cross(tangent, o.xyz);
  let towards_side = dot(n, lateral) * dot(n, lateral) / max(dot(lateral, lateral), 1e-9);
  let hidden = 0.26 * o.w + 0.5 * dot(o.xyz, n) + 0.55 * sides * towards_side;
  let open = clamp(1.0 - 0.8 * hidden, 0.08, 1.0);
  // Deeper parts are a little darker, so that layers read in depth.
  let deep = clamp(0.2 + 0.8 * (hit.z - view.fade.x) / view.fade.y, 0.0, 1.0);
  let light = normalize(vec3<f32>(-0.35, 0.62, 0.70));
  let diffuse = max(dot(n, light), 0.0);
  let sky = 0.30 + 0.16 * n.y + 0.14 * n.z;
  // Powers by squaring: 32 for the highlight, 3 along silhouettes.
  let half2 = square(max(dot(n, normalize(light + vec3<f32>(0.0, 0.0, 1.0))), 0.0));
  let glint = square(square(square(square(half2))));
  let rim = 1.0 - clamp(n.z, 0.0, 1.0);
  let slant = rim * rim * rim;
  var colour = base * (sky * open + 0.78 * diffuse * mix(0.45, 1.0, open)) * mix(0.6, 1.0, deep) * mix(in.ca.w, in.cb.w, s);
  colour += (0.025 + 0.14 * base) * glint * open;
  colour = colour * (1.0 - view.rim.w * slant) + view.rim.rgb * (0.35 + 3.0 * base) * slant * open * open;
  // A broken end keeps its colour also in the shade.
  colour = mix(colour, max(colour, base * 0.55), broken);

  var lit: Lit;
  lit.colour = vec4<f32>(colour, 1.0);
  lit.depth = clamp(0.5 - 0.5 * hit.z / view.scale.z, 0.0, 1.0);
  return lit;
}

struct Masked {
  @location(0) colour: vec4<f32>,
  @builtin(frag_depth) depth: f32,
  @builtin(sample_mask) mask: u32,
};

// Smooth silhouettes: coverage tested at each of the four sample points, shading once, at the middle of those
// that are covered (the outline is convex, so that point is inside).
@fragment fn fs_masked(in: Varying) -> Masked {
  let dx = dpdx(in.p);
  let dy = dpdy(in.p);
  var offsets = array<vec2<f32>, 4>(vec2<f32>(-0.125, -0.375), vec2<f32>(0.375, -0.125),
                                    vec2<f32>(-0.375, 0.125), vec2<f32>(0.125, 0.375));
  var mask = 0u;
  var sum = vec2<f32>(0.0);
  var count = 0.0;
  let along = outline_axis(in);
  for (var i = 0u; i < 4u; i++) {
    let q = in.p + dx * offsets[i].x + dy * offsets[i].y;
    if (covers(q, in.a, in.b, along)) {
      mask |= 1u << i;
      sum += q;
      count += 1.0;
    }
  }
  if (mask == 0u) { discard; }
  let lit = shade(sum / count, in);
  return Masked(lit.colour, lit.depth, mask);
}

struct Whole {
  @location(0) colour: vec4<f32>,
  @builtin(frag_depth) depth: f32,
};

// For adapters without a sample mask: whole pixels.
@fragment fn fs_whole(in: Varying) -> Whole {
  if (!covers(in.p, in.a, in.b, outline_axis(in))) { discard; }
  let lit = shade(in.p, in);
  return Whole(lit.colour, lit.depth);
}
