// The share of the light from d (unit) that reaches this pixel, from the baked coefficients.
#if HAS_VISIBILITY
varying vec3 v_visible0;
varying vec3 v_visible1;
varying vec3 v_visible2;
real visible(vec3 d) { return visible_part(v_visible0, v_visible1, v_visible2, d); }
#else
real visible(vec3 d) { return 1.0; }
#endif
