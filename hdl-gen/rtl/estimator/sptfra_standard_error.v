// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Standard error of the tangential force over |F_z|, as a logarithm: model, noise and border, added as squares.
//
// s = |MODEL, NOISE left largest / stress_sum, BORDER e|. e is the share of stress at the grid's border beyond 1/32.
// Noise that is alike in all frames has a typical contact's LARGEST, scaled as the frame is, in place of largest.
// |x, y| is max(x, y, 7/8 of the larger + 1/2 of the smaller). No multiplier: each bit of a quotient adds its weight.
// The noise left is the root of the variance; its bits, as they are found, add up NOISE. Without averages it is 1.
// stress_sum is not 0. Latency: 56 cycles from start to the result, which holds until the next start.

`default_nettype none

module sptfra_standard_error #(
    // Error of the model, as a share of |F_z| with 16 fraction bits
    parameter [17:0] MODEL = 18'd0,
    // Errors by noise and by stress at the border, as the header multiplies them, with 13 fraction bits
    parameter [16:0] NOISE = 17'd0,
    parameter [16:0] BORDER = 17'd0,
    // A sixteenth of the largest stress of a typical contact, 0: noise is a share of each frame's own
    parameter [22:0] LARGEST = 23'd0,
    // 1: frames are averaged
    parameter AVERAGED = 0
) (
    input  wire clock,
    input  wire reset,
    input  wire start, // with these
    input  wire [39:0] stress_sum, // sum |b|
    input  wire [26:0] largest, // max |b|
    input  wire [4:0] frame_exponent, // the frame is scaled by 2 to the power of it
    input  wire [39:0] border, // sum |b| of the taxels at the border
    input  wire [24:0] variance, // of the noise left in an average, 24 fraction bits
    output reg  signed [17:0] error_log // of base 2, from -10 to 2, 12 fraction bits: n + f for 2^n (1 + f)
);

    localparam [5:0] BORDER_END = 6'd18, NOISE_END = 6'd35, ADD = 6'd36, CLIP = 6'd42, LAST = 6'd54;
    localparam [17:0] LEAST = 18'd64; // 2^-10
    localparam [22:0] MOST = 23'd262143; // just below 4

    reg busy;
    reg [5:0] step;
    // ---- Two quotients by non-restoring division, a bit a cycle, the border's first. A remainder that is not negative
    // makes the bit 1, and the divisor is subtracted next. Else it is added
    reg [39:0] divisor;
    reg [40:0] part; // the dividend
    reg [41:0] remainder;
    wire [40:0] peak; // below twice the divisor
    wire [16:0] noise; // its weight in this frame
    reg [33:0] sum; // of the weights
    wire first = (step == 6'd1) || (step == BORDER_END);
    wire [41:0] shifted = first ? {1'b0, part} : {remainder[40:0], 1'b0};
    wire fits = !remainder[41];
    wire [16:0] weight = (step > BORDER_END) ? noise : BORDER;
    wire [33:0] next_sum = {sum[32:0], 1'b0} + (fits ? {17'd0, weight} : 34'd0);
    wire [39:0] allowed = {5'd0, divisor[39:5]};

    // ---- What the noise is a share of, and what it comes to
    wire [22:0] by_noise;
    if (LARGEST != 23'd0) begin : gen_typical
        reg [53:0] scaled;
        reg [40:0] most;
        reg too_large;

        assign peak = too_large ? most : scaled[40:0];
        // A quotient of sixteenths; 64 |F_z| are as good as more
        assign by_noise = (next_sum[33:31] != 3'd0) ? 23'h3fffff : {1'b0, next_sum[30:9]};

        always @(posedge clock) begin
            most <= {divisor, 1'b0} - 41'd1;
            too_large <= (scaled > {13'd0, most});
            if (start) begin
                scaled <= {31'd0, LARGEST} << frame_exponent;
            end
        end

        wire _unused_largest = &{1'b0, largest};
    end else begin : gen_own
        reg [26:0] held;

        assign peak = {14'd0, held};
        assign by_noise = {2'd0, next_sum[33:13]};

        always @(posedge clock) begin
            if (start) begin
                held <= largest;
            end
        end

        wire _unused_exponent = &{1'b0, frame_exponent};
    end

    // ---- Two errors added, then with the third: each in three cycles, for short paths
    reg [22:0] share_noise;
    reg [22:0] share_border;
    reg [22:0] total;
    reg [22:0] larger;
    reg [22:0] smaller;
    reg [22:0] mixed;
    wire [22:0] other = (step == ADD) ? share_noise : share_border;
    wire is_larger = (total > other);

    // ---- Logarithm
    reg [17:0] mantissa;
    reg signed [5:0] exponent;

    always @(posedge clock) begin
        if (start) begin
            busy <= 1'b1;
            step <= 6'd0;
            divisor <= stress_sum;
            part <= {1'b0, border};
            total <= {5'd0, MODEL};
        end else if (busy) begin
            step <= step + 6'd1;
            part <= (step != 6'd0) ? peak : (part[39:0] > allowed) ? part - {1'b0, allowed} : 41'd0;
            remainder <= (first || fits) ? shifted - {2'b00, divisor} : shifted + {2'b00, divisor};
            sum <= next_sum;
            if (first) begin
                share_border <= {2'd0, next_sum[33:13]};
                sum <= 34'd0;
            end
            if (step == NOISE_END) begin
                share_noise <= by_noise;
            end
            if ((step == ADD) || (step == ADD + 6'd3)) begin
                larger <= is_larger ? total : other;
                smaller <= is_larger ? other : total;
            end
            mixed <= larger - {3'd0, larger[22:3]} + {1'b0, smaller[22:1]};
            if ((step == ADD + 6'd2) || (step == ADD + 6'd5)) begin
                total <= (mixed > larger) ? mixed : larger;
            end
            if (step == CLIP) begin
                mantissa <= (total > MOST) ? MOST[17:0] : (total[17:0] < LEAST) ? LEAST : total[17:0];
                exponent <= 6'sd1;
            end else if (!mantissa[17]) begin
                mantissa <= {mantissa[16:0], 1'b0};
                exponent <= exponent - 6'sd1;
            end
            if (step == LAST) begin
                busy <= 1'b0;
                error_log <= {exponent, mantissa[16:5]};
            end
        end
        if (reset) begin
            busy <= 1'b0;
        end
    end

    // ---- Root of the variance, two bits of it a cycle, and its product with NOISE
    if (AVERAGED != 0) begin : gen_averaged
        reg [25:0] radicand; // what is left of it
        reg [12:0] root;
        reg [14:0] rest;
        reg [29:0] product;
        wire [16:0] trial = {rest, radicand[25:24]} - {2'b00, root, 2'b01};
        wire bit_there = !trial[16];

        assign noise = product[28:12];

        always @(posedge clock) begin
            if (start) begin
                radicand <= {1'b0, variance};
                root <= 13'd0;
                rest <= 15'd0;
                product <= 30'd0;
            end else if (step < 6'd13) begin
                radicand <= {radicand[23:0], 2'b00};
                root <= {root[11:0], bit_there};
                rest <= bit_there ? trial[14:0] : {rest[12:0], radicand[25:24]};
                product <= {product[28:0], 1'b0} + (bit_there ? {13'd0, NOISE} : 30'd0);
            end
        end

        wire _unused_averaged = &{1'b0, trial[15], product[29], product[11:0]};
    end else begin : gen_alone
        assign noise = NOISE;
        wire _unused_variance = &{1'b0, variance};
    end

    wire _unused = &{1'b0, mantissa[4:0], sum[33], smaller[0]};

endmodule

`default_nettype wire
