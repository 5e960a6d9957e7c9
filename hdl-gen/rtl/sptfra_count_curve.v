// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Counts along a curve that stands in the two banks of a calibration: a stream of samples in, one of float32 out, the
// curve's pascals. NaN for what is no number, the largest float with the sign of the value for a count at an end of the
// curve: what that means is not known.
//
// A frame takes its curve from the bank that acts at its first beat. Beat to beat: LEVELS + 21 cycles, one beat a
// cycle. Names end in the number of cycles since the beat came in.

`default_nettype none

module sptfra_count_curve #(
    // What a sample is: 0 float32, 1 a 16-bit integer, 2 one without a sign
    parameter SAMPLE = 0,
    // Comparisons: the curve has up to 2^LEVELS segments
    parameter LEVELS = 4,
    // number = round(count * 2^NUMBER_SHIFT); a step of the value is 2^VALUE_LSB Pa
    parameter integer NUMBER_SHIFT = 0,
    parameter integer VALUE_LSB = 0,
    // Cycles that the plan counts on; 0: any
    parameter EXPECTED_STAGES = 0,
    // Derived
    parameter SAMPLE_BITS = (SAMPLE == 0) ? 32 : 16,
    parameter SEGMENTS = 1 << LEVELS
) (
    input  wire clock,
    input  wire reset,
    // Samples in
    input  wire [SAMPLE_BITS-1:0] s_tdata,
    input  wire s_tlast,
    input  wire s_tvalid,
    output wire s_tready,
    // Pascals out
    output wire [31:0] m_tdata,
    output wire m_tlast,
    output wire m_tvalid,
    input  wire m_tready,
    output reg  m_begins, // the next beat is a frame's first
    // Banks
    input  wire active, // of the frames that begin
    output wire frame_begins,
    input  wire [2*27*SEGMENTS-1:0] knots,
    input  wire [13:0] counts,
    input  wire [53:0] lasts,
    input  wire [53:0] reaches,
    output wire line_enable,
    output wire line_bank,
    output wire [LEVELS-1:0] line_segment,
    input  wire signed [26:0] line_first,
    input  wire signed [26:0] line_value,
    input  wire signed [17:0] line_slope,
    input  wire [5:0] line_shift
);

    localparam CLAMPED = 7;
    localparam FOUND = CLAMPED + LEVELS; // the segment is known
    localparam VALUED = FOUND + 6;
    localparam STAGES = VALUED + 7;
    localparam SKID = 1;
    localparam [26:0] NUMBER_BOUND = 27'd33554431;
    localparam [31:0] QUIET_NAN = 32'h7fc00000;
    localparam [30:0] LARGEST_FLOAT = 31'h7f7fffff;
    localparam [31:0] SHIFT_WIDE = NUMBER_SHIFT;
    localparam [31:0] LSB_WIDE = VALUE_LSB;
    localparam signed [9:0] SHIFT = SHIFT_WIDE[9:0];
    localparam signed [9:0] LSB = LSB_WIDE[9:0];

    generate
        if ((EXPECTED_STAGES != 0) && (EXPECTED_STAGES != STAGES + SKID)) begin : gen_check_stages
            sptfra_error_the_plan_counts_on_other_stages invalid ();
        end
    endgenerate

    // ---- Frames, and the bank of each
    wire advance; // of the skid buffer behind, a register
    reg in_frame;
    reg bank_held;
    reg [1:0] ends_inside; // last beats on their way: packets of a beat must not pile up here
    wire bank = in_frame ? bank_held : active;
    wire accept = s_tvalid && s_tready;
    wire leaves = m_tvalid && m_tready;
    reg [STAGES:1] valid;
    reg [STAGES:1] ends;
    reg [FOUND:1] banks;

    assign s_tready = advance && (in_frame || (ends_inside != 2'd3));
    assign frame_begins = accept && !in_frame;

    always @(posedge clock) begin
        if (accept) begin
            in_frame <= !s_tlast;
            bank_held <= bank;
        end
        if (leaves) begin
            m_begins <= m_tlast;
        end
        ends_inside <= ends_inside + {1'b0, accept && s_tlast} - {1'b0, leaves && m_tlast};
        if (advance) begin
            valid <= {valid[STAGES-1:1], accept};
            ends <= {ends[STAGES-1:1], s_tlast};
            banks <= {banks[FOUND-1:1], bank};
        end
        if (reset) begin
            in_frame <= 1'b0;
            bank_held <= 1'b0;
            m_begins <= 1'b1;
            ends_inside <= 2'd0;
            valid <= {STAGES{1'b0}};
        end
    end

    // ---- Sample to a number
    reg [SAMPLE_BITS-1:0] sample_1;
    wire signed [26:0] number_6;
    wire saturated_6;
    wire not_finite_6;

    always @(posedge clock) begin
        if (advance) begin
            sample_1 <= s_tdata;
        end
    end

    generate
        if (SAMPLE == 0) begin : gen_float
            sptfra_float_to_fixed float_to_fixed (
                .clock      (clock),
                .enable     (advance),
                .float_bits (sample_1),
                .shift      (SHIFT),
                .limit      (NUMBER_BOUND),
                .fixed      (number_6),
                .saturated  (saturated_6),
                .not_finite (not_finite_6)
            );
        end else begin : gen_integer
            sptfra_int_to_fixed #(
                .SIGNED ((SAMPLE == 1) ? 1 : 0)
            ) int_to_fixed (
                .clock     (clock),
                .enable    (advance),
                .count     (sample_1),
                .shift     (SHIFT),
                .limit     (NUMBER_BOUND),
                .fixed     (number_6),
                .saturated (saturated_6)
            );

            assign not_finite_6 = 1'b0;
        end
    endgenerate

    // ---- Ends of the curve
    wire bank_6 = banks[CLAMPED-1];
    wire signed [26:0] first_6 = bank_6 ? $signed(knots[27*SEGMENTS +: 27]) : $signed(knots[26:0]);
    wire signed [26:0] last_6 = bank_6 ? $signed(lasts[53:27]) : $signed(lasts[26:0]);
    wire [26:0] reach_6 = bank_6 ? reaches[53:27] : reaches[26:0];
    wire [26:0] magnitude_6 = number_6[26] ? -number_6 : number_6;
    reg signed [26:0] number_7;
    reg [STAGES:CLAMPED] beyond;
    reg [STAGES:CLAMPED] not_finite;

    always @(posedge clock) begin
        if (advance) begin
            number_7 <= (number_6 < first_6) ? first_6 : (number_6 > last_6) ? last_6 : number_6;
            beyond <= {beyond[STAGES-1:CLAMPED], magnitude_6 >= reach_6};
            not_finite <= {not_finite[STAGES-1:CLAMPED], not_finite_6};
        end
    end

    // ---- The segment: bit by bit of its number, the highest first
    wire [27*(LEVELS+1)-1:0] numbers;
    wire [LEVELS*(LEVELS+1)-1:0] segments;
    genvar level;

    assign numbers[26:0] = number_7;
    assign segments[LEVELS-1:0] = {LEVELS{1'b0}};

    generate
        for (level = 0; level < LEVELS; level = level + 1) begin : gen_levels
            localparam [LEVELS-1:0] BIT = 1 << (LEVELS - 1 - level);
            reg signed [26:0] held_number;
            reg [LEVELS-1:0] held_segment;
            wire signed [26:0] here = $signed(numbers[27*level +: 27]);
            wire [LEVELS-1:0] segment = segments[LEVELS*level +: LEVELS];
            wire [LEVELS-1:0] upper = segment | BIT;
            wire bank_here = banks[CLAMPED+level];
            wire [6:0] count = bank_here ? counts[13:7] : counts[6:0];
            wire signed [26:0] knot = $signed(knots[27*{bank_here, upper} +: 27]);

            assign numbers[27*(level+1) +: 27] = held_number;
            assign segments[LEVELS*(level+1) +: LEVELS] = held_segment;

            always @(posedge clock) begin
                if (advance) begin
                    held_number <= here;
                    held_segment <= (({{(7-LEVELS){1'b0}}, upper} < count) && (here >= knot)) ? upper : segment;
                end
            end
        end
    endgenerate

    assign line_enable = advance;
    assign line_bank = banks[FOUND];
    assign line_segment = segments[LEVELS*LEVELS +: LEVELS];

    // ---- Its line: names end in the cycles since the segment is known
    reg signed [26:0] number_1;
    reg signed [26:0] along_2;
    reg signed [17:0] slope_2;
    reg signed [26:0] value_2;
    reg signed [26:0] value_3;
    reg signed [26:0] value_4;
    reg signed [26:0] value_5;
    reg signed [26:0] value_6;
    reg [5:0] shift_2;
    reg [5:0] shift_3;
    reg [5:0] shift_4;
    wire signed [44:0] product_low_3; // the product is their sum
    wire signed [44:0] product_high_3;
    reg signed [44:0] product_4;
    reg signed [44:0] rise_5; // twice what it is, to be rounded
    wire signed [44:0] rise_half = rise_5 + 45'sd1;

    sptfra_multiply multiplier (
        .clock       (clock),
        .enable      (advance),
        .coefficient (slope_2),
        .data        (along_2),
        .low         (product_low_3),
        .high        (product_high_3)
    );

    always @(posedge clock) begin
        if (advance) begin
            number_1 <= $signed(numbers[27*LEVELS +: 27]);
            along_2 <= number_1 - line_first;
            slope_2 <= line_slope;
            shift_2 <= line_shift - 6'd1;
            value_2 <= line_value;
            shift_3 <= shift_2;
            value_3 <= value_2;
            product_4 <= product_low_3 + product_high_3;
            shift_4 <= shift_3;
            value_4 <= value_3;
            rise_5 <= product_4 >>> shift_4;
            value_5 <= value_4;
            value_6 <= value_5 + rise_half[27:1];
        end
    end

    // ---- Out, as float32
    wire [31:0] float_out;
    wire [31:0] pascals = not_finite[STAGES] ? QUIET_NAN : beyond[STAGES] ? {float_out[31], LARGEST_FLOAT} : float_out;

    sptfra_fixed_to_float fixed_to_float (
        .clock      (clock),
        .enable     (advance),
        .fixed      ({{37{value_6[26]}}, value_6}),
        .exponent   (LSB),
        .float_bits (float_out)
    );

    sptfra_axis_skid skid (
        .clock    (clock),
        .reset    (reset),
        .s_tdata  (pascals),
        .s_tlast  (ends[STAGES]),
        .s_tvalid (valid[STAGES]),
        .s_tready (advance),
        .m_tdata  (m_tdata),
        .m_tlast  (m_tlast),
        .m_tvalid (m_tvalid),
        .m_tready (m_tready)
    );

    // A number at its bound is at the end of every curve
    wire _unused = &{1'b0, saturated_6, rise_half[44:28], rise_half[0], SHIFT_WIDE, LSB_WIDE};

endmodule

`default_nettype wire
