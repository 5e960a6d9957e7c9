// SPDX-License-Identifier: MIT OR Apache-2.0
//
// Frame scale: each frame has one power of two, which is there two cycles after the lanes may have the frame, and held.
//
// Assumed: nothing comes while a frame is inside, and it leaves two cycles after the lanes may have it, or later.
module harness (
    input wire clock,
    input wire beat_valid,
    input wire [53:0] stresses,
    input wire ends,
    input wire bad_length,
    input wire restart
);

    reg started = 1'b0;
    wire reset = !started;
    wire whole;
    wire scaled;
    wire [4:0] exponent;
    wire [7:1] settles;

    sptfra_frame_scale subject (
        .clock      (clock),
        .reset      (reset),
        .beat_valid (beat_valid),
        .stresses   (stresses),
        .ends       (ends),
        .bad_length (bad_length),
        .averaged   (1'b0),
        .restart    (restart),
        .whole      (whole),
        .scaled     (scaled),
        .exponent   (exponent),
        // Inside
        .settles    (settles)
    );

    reg inside;
    reg [2:0] known; // cycles since the lanes may have the frame
    reg held;
    reg [4:0] held_exponent;

    always @(posedge clock) begin
        started <= 1'b1;
        inside <= ends || (inside && !restart);
        known <= restart ? 3'd0 : {known[1:0], whole};
        held <= known[1] && !restart;
        held_exponent <= exponent;
        if (reset) begin
            inside <= 1'b0;
            known <= 3'd0;
            held <= 1'b0;
        end
    end

    always @(*) begin
        assume (started || !(beat_valid || ends || restart));
        assume (!inside || !(beat_valid || ends));
        assume (!restart || (inside && known[1]));
    end

    always @(posedge clock) begin
        if (!reset) begin
            assert (!whole || inside);
            // Once a frame, two cycles after the lanes may have it
            assert (scaled == (known[1] && !known[2]));
            assert (!held || (exponent == held_exponent));
        end
    end

`ifdef INVARIANTS
    wire [3:0] tokens = 4'd0 + settles[1] + settles[2] + settles[3] + settles[4] + settles[5] + whole;

    always @(posedge clock) begin
        if (!reset) begin
            assert (tokens == {3'd0, inside});
            assert (settles[6] == (whole && !known[0]));
            assert (settles[7] == (known[0] && !known[1]));
            assert (!known[0] || whole);
            assert (!known[1] || known[0]);
            assert (!known[2] || known[1]);
            assert (!held || known[2]);
        end
    end
`endif

endmodule
