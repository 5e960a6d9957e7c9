// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// A range of its own for each frame: its stresses are scaled by the largest power of two, not below one, that keeps the
// largest of them within the full scale, and then go to the lanes' operand memories, folded or as they are.
//
// A frame is folded as it comes, without a rounding, and kept; with its last stress the largest is known. From there to
// the last write: 9 cycles and one an element. Everything behind the lanes' operands is homogeneous, so that the
// scaled frame has the friction of the frame, and forces that are larger by its power of two: see sptfra_frame_context.

`default_nettype none

module sptfra_range #(
    // Taxels in x and y
    parameter COLUMNS = 10,
    parameter ROWS = 10,
    // 4: folded into parity classes; 1: as they are
    parameter WAYS = 4,
    // Bits of a stress, 27 at most, and of what the lanes read: as many, or 29 and more where taxels are folded
    parameter DATA_BITS = 27,
    // Full scale, in steps of the stress
    parameter signed [26:0] STRESS_BOUND = 27'sd51200000,
    // From the last stress to the last write, checked in simulation; 0: unchecked
    parameter integer EXPECTED_LATENCY = 0,
    // Derived
    parameter ELEMENTS = (WAYS == 1) ? COLUMNS * ROWS : ((COLUMNS + 1) / 2) * ((ROWS + 1) / 2),
    parameter ROW_WIDTH = (ELEMENTS > 8) ? $clog2(ELEMENTS) : 3
) (
    input  wire clock,
    input  wire reset,
    // From Bz: each stress, then the end of the frame, with the last one or after it
    input  wire stress_valid,
    input  wire signed [26:0] stress,
    input  wire frame_done,
    input  wire frame_bad_length,
    output wire idle, // the next frame may come
    // Operand memories, class 0 in the lowest bits
    output wire write_valid,
    input  wire write_ready,
    output wire write_bank,
    output wire [ROW_WIDTH-1:0] write_row,
    output wire [WAYS*DATA_BITS-1:0] write_data,
    output wire frame_ready, // a whole frame waits
    input  wire frame_start, // the lanes begin with it
    // The frame's power of two, for one cycle, before it is ready
    output reg  scaled,
    output reg  [4:0] exponent
);

    localparam [31:0] BOUND_WIDE = {5'd0, STRESS_BOUND};
    localparam [31:0] BOUND_BITS = $clog2(BOUND_WIDE + 1);
    // Four stresses make a class, a quarter as fine if it has no room for their sum
    localparam STRESS_BITS = (DATA_BITS < 27) ? DATA_BITS : 27;
    localparam WIDTH = (WAYS == 4) ? STRESS_BITS + 2 : STRESS_BITS;
    localparam DROPPED = (DATA_BITS < WIDTH) ? 2 : 0;
    localparam signed [WIDTH-1:0] HALF = DROPPED; // half a step of the result, for the rounding
    localparam DEPTH = (ELEMENTS > 8) ? ELEMENTS : 8;
    localparam [31:0] LAST_WIDE = ELEMENTS - 1;
    localparam [ROW_WIDTH-1:0] LAST = LAST_WIDE[ROW_WIDTH-1:0];

    generate
        if ((WAYS != 1) && (WAYS != 4)) begin : gen_check_ways
            sptfra_error_ways_must_be_1_or_4 invalid ();
        end
    endgenerate

    // ---- The largest magnitude, and the power of two: there 7 cycles after the frame's end, and held
    reg valid_1;
    reg [26:0] magnitude_1;
    reg [26:0] most;
    reg [6:1] settles; // index k: k cycles after the end
    reg bad_length;
    wire [5:0] most_bits; // two cycles behind
    reg [4:0] guess; // brings the leading bit to that of the full scale
    reg [26:0] guessed;

    sptfra_leading_bit #(
        .WIDTH (32)
    ) leading_bit (
        .clock (clock),
        .value ({5'd0, most}),
        .bits  (most_bits)
    );

    always @(posedge clock) begin
        valid_1 <= stress_valid;
        magnitude_1 <= stress[26] ? -stress : stress;
        if (valid_1) begin
            most <= (magnitude_1 > most) ? magnitude_1 : most;
        end
        guess <= BOUND_BITS[4:0] - most_bits[4:0];
        guessed <= most << guess;
        settles <= {settles[5:1], frame_done};
        if (frame_done) begin
            bad_length <= frame_bad_length;
        end
        scaled <= settles[6];
        if (settles[6]) begin
            // What another frame has left where this one is too short is not this one's to scale
            exponent <= bad_length ? 5'd0 : (guessed > STRESS_BOUND) ? guess - 5'd1 : guess;
        end
        if (reset) begin
            valid_1 <= 1'b0;
            settles <= 6'd0;
            scaled <= 1'b0;
        end
        if (reset || settles[6]) begin
            most <= 27'd0;
        end
    end

    // ---- The frame, as sums that nothing was dropped from
    wire keep_valid;
    wire [ROW_WIDTH-1:0] keep_row;
    wire [WAYS*WIDTH-1:0] keep_data;
    wire [WAYS*WIDTH-1:0] kept_1;
    reg [ROW_WIDTH-1:0] element;

    generate
        if (WAYS == 4) begin : gen_fold
            wire bank;
            wire written;

            sptfra_fold #(
                .COLUMNS     (COLUMNS),
                .ROWS        (ROWS),
                .STRESS_BITS (STRESS_BITS),
                .DATA_BITS   (WIDTH)
            ) fold (
                .clock         (clock),
                .reset         (reset),
                .advance       (1'b1),
                .in_valid      (stress_valid || frame_done),
                .in_store      (stress_valid),
                .in_last       (frame_done),
                .in_stress     (stress[STRESS_BITS-1:0]),
                .write_valid   (keep_valid),
                .write_bank    (bank),
                .write_quad    (keep_row),
                .write_data    (keep_data),
                .frame_written (written)
            );

            wire _unused_fold = &{1'b0, bank, written};
        end else begin : gen_taxels
            reg [ROW_WIDTH-1:0] taxel;

            assign keep_valid = stress_valid;
            assign keep_row = taxel;
            assign keep_data = stress[STRESS_BITS-1:0];

            always @(posedge clock) begin
                if (stress_valid) begin
                    taxel <= taxel + 1'b1;
                end
                if (reset || frame_done) begin
                    taxel <= {ROW_WIDTH{1'b0}};
                end
            end
        end
    endgenerate

    sptfra_ram #(
        .WIDTH         (WAYS * WIDTH),
        .DEPTH         (DEPTH),
        .ADDRESS_WIDTH (ROW_WIDTH)
    ) frame (
        .clock         (clock),
        .write_enable  (keep_valid),
        .write_address (keep_row),
        .write_data    (keep_data),
        .read_enable   (write_ready),
        .read_address  (element),
        .read_data     (kept_1)
    );

    // ---- Out of it: from 5 cycles after the frame's end on, an element a cycle while nothing else is written.
    // Index k: k such cycles after the element's turn
    reg busy;
    reg reads;
    reg [5:1] valid;
    reg [5:1] lasts;
    reg [ROW_WIDTH-1:0] row;
    reg bank;
    wire turn_is_last = reads && (element == LAST);
    wire frame_written = lasts[5] && write_ready;

    assign idle = !busy;
    assign write_valid = valid[5];
    assign write_bank = bank;
    assign write_row = row;

    always @(posedge clock) begin
        if (write_ready) begin
            valid <= {valid[4:1], reads};
            lasts <= {lasts[4:1], turn_is_last};
            if (reads) begin
                element <= turn_is_last ? {ROW_WIDTH{1'b0}} : element + 1'b1;
            end
            if (turn_is_last) begin
                reads <= 1'b0;
            end
            if (valid[5]) begin
                row <= lasts[5] ? {ROW_WIDTH{1'b0}} : row + 1'b1;
            end
        end
        if (settles[4]) begin
            reads <= 1'b1;
        end
        if (frame_done) begin
            busy <= 1'b1;
        end
        if (frame_written) begin
            busy <= 1'b0;
            bank <= !bank;
        end
        if (reset) begin
            busy <= 1'b0;
            reads <= 1'b0;
            valid <= 5'd0;
            lasts <= 5'd0;
            element <= {ROW_WIDTH{1'b0}};
            row <= {ROW_WIDTH{1'b0}};
            bank <= 1'b0;
        end
    end

    genvar way;
    genvar place;
    generate
        for (way = 0; way < WAYS; way = way + 1) begin : gen_ways
            reg signed [WIDTH-1:0] kept_2;
            reg signed [WIDTH-1:0] octets_3;
            reg signed [WIDTH-1:0] exact_4;
            reg signed [WIDTH-1:0] rounded_5;

            always @(posedge clock) begin
                if (write_ready) begin
                    kept_2 <= kept_1[WIDTH*way +: WIDTH];
                    octets_3 <= kept_2 <<< {exponent[4:3], 3'd0};
                    exact_4 <= octets_3 <<< exponent[2:0];
                    rounded_5 <= exact_4 + HALF;
                end
            end

            for (place = 0; place < DATA_BITS; place = place + 1) begin : gen_bits
                assign write_data[DATA_BITS*way+place]
                    = rounded_5[(place + DROPPED < WIDTH) ? place + DROPPED : WIDTH - 1];
            end

            wire _unused_way = &{1'b0, rounded_5};
        end
    endgenerate

    // ---- Frames that wait
    reg [1:0] frames_waiting;

    assign frame_ready = (frames_waiting != 2'd0);

    always @(posedge clock) begin
        frames_waiting <= frames_waiting + {1'b0, frame_written} - {1'b0, frame_start};
        if (reset) begin
            frames_waiting <= 2'd0;
        end
    end

    sptfra_check_latency #(
        .CYCLES (EXPECTED_LATENCY)
    ) check_latency (
        .clock (clock),
        .reset (reset || !write_ready),
        .start (frame_done),
        .done  (frame_written)
    );

    wire _unused = &{1'b0, most_bits, BOUND_BITS};

endmodule

`default_nettype wire
